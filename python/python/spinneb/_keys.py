"""The keys of a config, and which of them was meant by a word that is none."""

from __future__ import annotations

import functools
import json
from collections.abc import Iterable

from . import _core

__all__ = ["check_keys", "hint"]


@functools.cache
def config_keys() -> tuple[str, ...]:
    """All keys of a config."""
    return tuple(json.loads(_core.config_schema())["properties"])


def hint(word: str, known: Iterable[str]) -> str:
    """The known word that is like it, as a question; nothing where none is."""
    import difflib

    near = difflib.get_close_matches(word, sorted(known), n=1)
    return f": did you mean {near[0]!r}?" if near else ""


def check_keys(words: Iterable[str], more: Iterable[str]) -> None:
    """An error where one is neither a key of a config nor one of these."""
    known = {*config_keys(), *more}
    for word in words:
        if word not in known:
            raise TypeError(f"there is no key {word!r} in a config" + hint(word, known))
