"""The command ``spinneb``, as ``python -m spinneb`` too."""

from __future__ import annotations

import signal
import sys

from . import _core


def main() -> int:
    """Does what the command line asks for; the exit code."""
    # Ctrl-C is the program's own to handle
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _core.main([sys.executable, "-m", "spinneb"], sys.argv[1:])


if __name__ == "__main__":
    sys.exit(main())
