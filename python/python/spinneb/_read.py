"""A config that is a dictionary, read."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from . import _core
from ._errors import ConfigError
from ._values import as_guess, as_json
from .term import Term

#: the file of a first path of vectors
_GUESS = "guess.npy"


def read(config: dict[str, Any], terms: Sequence[Term], kind: str, sets: list[str]) -> _core.Config:
    """With terms of one's own, and keys in place of its own, each as ``key=JSON``."""
    import tempfile

    with tempfile.TemporaryDirectory(prefix="spinneb-") as folder:
        try:
            return _core.Config(None, as_json(_with_files(config, folder)), os.getcwd(), sets, list(terms), kind)
        except ConfigError as error:
            # the file is ours, and gone
            own = f"path.guess.file.path: {os.path.join(folder, _GUESS)}"
            raise ConfigError(str(error).replace(own, "path.guess: the array")) from None


def _with_files(config: dict[str, Any], folder: str) -> dict[str, Any]:
    """A first path of vectors as a file; results keep it."""
    path = config.get("path")
    guess = path.get("guess") if isinstance(path, Mapping) else None
    if guess is None or isinstance(guess, Mapping):
        return config
    file = os.path.join(folder, _GUESS)
    np.save(file, as_guess(guess))
    return {**config, "path": {**path, "guess": {"file": {"path": file}}}}  # type: ignore[dict-item]
