"""What the builders make: pieces of a config, which are dictionaries."""

from __future__ import annotations

import json
import math
import operator
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._errors import ConfigError

__all__ = ["Direction", "Energy", "Extent", "Guess", "Lattice", "Optimiser", "Piece", "Selection", "Shape", "State", "Values"]

#: x, y and z of a direction, of any length, or the name of an axis: "z", "-x"
Direction = Union[str, Sequence[float], NDArray[np.floating[Any]]]
#: a length in lattice constants (in a chain, sites; in a grid, cells), or a string with its unit: "12 nm"
Extent = Union[float, str]
#: a string with its unit, a list of them, or a ramp or random values as a config has them
Values = Union[str, Sequence[Any], Mapping[str, Any]]
#: indices of sites, a range {"from": 3, "to": 9}, a shape, or the name of a region
Selection = Union[Sequence[int], NDArray[np.integer[Any]], Mapping[str, Any], str]

#: numbers
Array = NDArray[np.float64]

_AXES = {"x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}


def in_nm(places: Array, spacing_nm: float | None) -> Array | None:
    """Places in lattice constants in nm, read-only; None where the length of one is not known."""
    if spacing_nm is None:
        return None
    scaled: Array = places * spacing_nm
    scaled.flags.writeable = False
    return scaled


def as_direction(value: Any, what: str, *words: str) -> Any:
    """[0, 0, 1] for "z", [-1, 0, 0] for "-x", in lists too; one of the other words that stand here, and what is no text, as it is."""
    if isinstance(value, (list, tuple)):
        return [as_direction(inner, what) for inner in value]
    if not isinstance(value, str) or value in words:
        return value
    if not is_axis(value):
        others = "".join(f", or {word!r}" for word in words)
        raise ValueError(f"{what}: found {value!r}, expected x, y and z of a direction, or the name of an axis, 'z' or '-x'{others}")
    sign = -1 if value.startswith("-") else 1
    return [sign * number for number in _AXES[value[-1]]]


def is_axis(text: str) -> bool:
    """Whether it is the name of an axis: "z", "-x"."""
    return text.lstrip("+-") in _AXES and len(text) <= 2


def as_cells(cells: tuple[int | Sequence[int], ...]) -> Any:
    """Numbers of cells that are given one by one, or together as one sequence."""
    first = cells[0] if len(cells) == 1 else cells
    given = [first] if np.ndim(first) == 0 else list(first)  # type: ignore[arg-type]
    return [as_count(number, "cells", 1) for number in given]


def as_count(value: Any, what: str, least: int | None = None) -> int | None:
    """A whole number, not below the least one that may be."""
    if value is None:
        return None
    try:
        found = operator.index(value)
    except TypeError:
        raise TypeError(f"{what}: found {value!r}, expected a whole number") from None
    if least is not None and found < least:
        raise ConfigError(f"{what}: found {found}, expected {least} or more")
    return found


def as_list(value: Any) -> Any:
    """A quantity alone as a list of one."""
    return [value] if isinstance(value, str) else value


def plain(value: Any) -> Any:
    """The value as JSON has it: arrays as lists, numbers of numpy as numbers, paths as text."""
    if isinstance(value, Mapping):
        return {str(key): plain(inner) for key, inner in value.items()}
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if isinstance(value, (list, tuple, range)):
        return [plain(inner) for inner in value]
    return value


def as_json(value: Any, indent: int | None = None) -> str:
    """The value as text, without numbers that JSON does not have."""
    content = plain(value)
    for place, number in _infinite(content, ""):
        raise ValueError(f"{place}: found {number}, expected a finite number")
    return json.dumps(content, indent=indent, ensure_ascii=False, allow_nan=False)


def _infinite(value: Any, place: str) -> Iterator[tuple[str, float]]:
    """Numbers that are none, with their places as messages tell them."""
    if isinstance(value, float) and not math.isfinite(value):
        yield place or "the value", value
    elif isinstance(value, dict):
        for key, inner in value.items():
            yield from _infinite(inner, f"{place}.{key}" if place else key)
    elif isinstance(value, list):
        for k, inner in enumerate(value):
            yield from _infinite(inner, f"{place}[{k}]")


class Piece(dict[str, Any]):
    """A piece of a config, ``{kind: {key: value}}``, that shows itself as the call that makes it."""

    def __init__(self, kind: str, content: Any) -> None:
        if isinstance(content, dict):
            content = {key: plain(value) for key, value in content.items() if value is not None}
        super().__init__({kind: plain(content)})

    @property
    def kind(self) -> str:
        """Its name in a config."""
        return next(iter(self))

    def __repr__(self) -> str:
        content = self[self.kind]
        if not isinstance(content, dict):
            return f"{self.kind}({content!r})"
        # numbers of cells stand alone, as the builders of lattices take them
        cells = [repr(number) for number in content.get("cells", [])]
        keys = [f"{key}={value!r}" for key, value in content.items() if key != "cells"]
        return f"{self.kind}({', '.join(cells + keys)})"

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (self.kind, self[self.kind])


class Lattice(Piece):
    """Where the spins are; see :mod:`spinneb.lattices`."""


class Energy(Piece):
    """An energy term; see :mod:`spinneb.terms`."""


class State(Piece):
    """A spin state; see :mod:`spinneb.states`."""


class Guess(Piece):
    """A first path; see :mod:`spinneb.guesses`."""


class Optimiser(Piece):
    """How a path is relaxed; see :mod:`spinneb.optimisers`."""


class Shape(Piece):
    """A part of space; see :mod:`spinneb.shapes`."""

    def __and__(self, other: Shape) -> Shape:
        return Shape("all", [self, other])

    def __or__(self, other: Shape) -> Shape:  # type: ignore[override]
        return Shape("any", [self, other])

    def __invert__(self) -> Shape:
        return Shape("not", self)


def spins(value: ArrayLike, what: str, sites: int | None = None) -> NDArray[np.float64]:
    """Vectors as (site, xyz), checked."""
    m = numbers(value, what)
    if m.ndim != 2 or m.shape[1] != 3 or (sites is not None and m.shape[0] != sites):
        wanted = f"({sites if sites is not None else 'sites'}, 3)"
        raise ValueError(f"{what}: found an array of shape {m.shape}, expected {wanted}")
    return finite(m, what)


#: a state of the package, one as a config has it, or vectors of the shape (N, 3)
AnyState = Union[State, Mapping[str, Any], ArrayLike]


def as_state(value: AnyState | None, what: str) -> Any:
    """A state as a config has it; vectors become one."""
    if value is None or isinstance(value, Mapping):
        return value
    if isinstance(value, str):
        such = f"uniform({value!r})" if is_axis(value) else "uniform([0, 0, 1])"
        raise TypeError(f"{what}: found the text {value!r}, expected a state, such as {such}, or vectors")
    return {"vectors": spins(value, what).tolist()}


def as_states(values: Sequence[AnyState], what: str) -> list[Any]:
    """Several of them."""
    return [as_state(value, f"{what}[{k}]") for k, value in enumerate(values)]


def path(value: ArrayLike, what: str) -> NDArray[np.float64]:
    """Vectors of a path as (image, site, xyz), checked."""
    m = numbers(value, what)
    if m.ndim != 3 or m.shape[2] != 3 or len(m) < 3:
        raise ValueError(f"{what}: found an array of shape {m.shape}, expected (images, sites, 3) with 3 images or more, both ends counted")
    return finite(m, what)


def as_guess(value: Guess | Mapping[str, Any] | ArrayLike) -> Any:
    """A first path as a config has it, or vectors of the shape (images, N, 3)."""
    if isinstance(value, Mapping):
        return value
    return path(value, "guess")


def numbers(value: ArrayLike, what: str) -> NDArray[np.float64]:
    """An array of real numbers, or an error that says what would be one."""
    # numpy would take what lies under a mask, real parts, and the numbers of words and truths
    if np.ma.is_masked(value):
        raise ValueError(f"{what}: found an array of which some numbers are masked: fill them first")
    try:
        found = np.asarray(value)
        if found.dtype.kind in "iufO":
            return found.astype(np.float64, copy=False)
        shown = f"an array of {found.dtype}" if found.ndim else repr(value)
    except (TypeError, ValueError):
        shown = repr(value)
    shown = shown if len(shown) <= 60 else f"{shown[:57]}..."
    raise TypeError(f"{what}: found {shown}, expected vectors, or what a builder such as uniform(…) or sweep(…) makes")


def finite(m: NDArray[np.float64], what: str) -> NDArray[np.float64]:
    """The vectors, or an error that names the first that is none."""
    bad = np.argwhere(~np.isfinite(m).all(axis=-1))
    if len(bad):
        place = ", ".join(f"{name} {k}" for name, k in zip(("image", "site")[2 - len(bad[0]) :], bad[0]))
        raise ValueError(f"{what}: {place}: {m[tuple(bad[0])].tolist()} has no direction: give three finite numbers")
    return m
