"""What the tests share."""

import os
import subprocess
import sys
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt
import pytest

import spinneb as sn

matplotlib.use("Agg")
CONFIGS = Path(os.environ.get("SPINNEB_CONFIGS") or Path(__file__).parents[2] / "configs")


@pytest.fixture(scope="session")
def configs():
    """The shipped configs."""
    return CONFIGS


@pytest.fixture(scope="session")
def command():
    """Runs the command line: that of SPINNEB_BIN, or the one that comes with the package."""

    def run(*arguments, **options):
        program = os.environ.get("SPINNEB_BIN")
        start = [program] if program else [sys.executable, "-m", "spinneb"]
        options = {"capture_output": True, "text": True, **options}
        return subprocess.run([*start, *map(str, arguments)], **options)

    return run


@pytest.fixture(autouse=True)
def figures():
    """Closes those of a test after it."""
    yield
    plt.close("all")


@pytest.fixture
def chain():
    """A chain whose wall enters at an end."""
    return sn.System(
        sn.chain(20), [sn.exchange(J=["10 meV"]), sn.anisotropy(K="0.5 meV")], moment="2 mu_B", name="chain"
    )


@pytest.fixture(scope="session")
def reversal():
    """Its result."""
    system = sn.System(
        sn.chain(20), [sn.exchange(J=["10 meV"]), sn.anisotropy(K="0.5 meV")], moment="2 mu_B", name="chain"
    )
    return sn.barrier(system, sn.uniform("z"), sn.uniform("-z"))
