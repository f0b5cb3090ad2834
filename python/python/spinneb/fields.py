"""Fields of discretisedfield (Ubermag), in and out."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._optional import needs
from ._values import Lattice
from .results import Result

if TYPE_CHECKING:
    import discretisedfield  # type: ignore[import-untyped,import-not-found,unused-ignore]

__all__ = ["from_field", "to_field"]

_NM = 1e-9


def from_field(field: discretisedfield.Field) -> tuple[Lattice, NDArray[np.float64], float]:
    """A lattice of the cells of a field, the directions of its vectors, and the largest of their lengths.

    Parameters
    ----------
    field
        Vectors of three components on a three-dimensional mesh in metres. Cells whose vector is zero become vacant sites.

    Returns
    -------
    lattice
        A ``grid``, periodic along the directions of the mesh's ``bc``.
    spins
        Unit vectors (N, 3), the first direction of the mesh fastest; +z where there is no spin.
    norm
        The largest length, which of a magnetisation is Ms in A/m.
    """
    if not hasattr(field, "mesh") or not hasattr(field, "array"):
        raise TypeError(f"from_field takes a field of discretisedfield, found {field!r}")
    mesh, values = field.mesh, np.asarray(field.array, dtype=np.float64)
    if values.ndim != 4 or values.shape[3] != 3:
        raise ValueError(f"found a field of shape {values.shape}, expected three components on a three-dimensional mesh")
    m = values.transpose(2, 1, 0, 3).reshape(-1, 3)
    length = np.linalg.norm(m, axis=1)
    there = length > 1e-9 * length.max(initial=0.0)
    if not there.any():
        raise ValueError("all vectors of the field are zero")
    m = np.where(there[:, None], m, [0.0, 0.0, 1.0])
    spins = m / np.linalg.norm(m, axis=1)[:, None]
    bc = str(mesh.bc)
    content: dict[str, Any] = {
        "cells": [int(n) for n in mesh.n],
        "cell": [f"{float(width) / _NM!r} nm" for width in mesh.cell],
        "periodic": [axis in bc for axis in "xyz"],
        "vacant": None if there.all() else np.flatnonzero(~there),
    }
    return Lattice("grid", content), spins, float(length.max())


def to_field(result: Result, image: int = 0, *, norm: float | None = None) -> discretisedfield.Field:
    """An image of a result as a field on the mesh of its cells.

    Parameters
    ----------
    result
        Of a ``grid`` without a shape. Where it has no spin the vectors are zero.
    image
        Which image; negative ones count from the end.
    norm
        The length of the vectors, 1 if left out; Ms makes a magnetisation of it.
    """
    needs("discretisedfield")
    import discretisedfield as df  # type: ignore[import-untyped,import-not-found,unused-ignore]

    lattice = result.config["lattice"]
    ((kind, content),) = lattice.items()
    m = result.spins[image]
    if kind != "grid" or content.get("shape") is not None:
        raise ValueError(f"a field needs the cells of a whole grid, and this is the lattice {Lattice(kind, content)!r}")
    cells = content["cells"]
    cell = [_length(width) for width in content["cell"]]
    mesh = df.Mesh(p1=(0, 0, 0), p2=tuple(n * width for n, width in zip(cells, cell)), n=tuple(cells))
    nx, ny, nz = cells
    values = m.reshape(nz, ny, nx, 3).transpose(2, 1, 0, 3).copy()
    values[result.vacant.reshape(nz, ny, nx).transpose(2, 1, 0)] = 0.0
    return df.Field(mesh, nvdim=3, value=values * (1.0 if norm is None else norm))


def _length(text: str) -> float:
    """Metres of a length in nm or another of the usual units."""
    number = text.rstrip("abcdefghijklmnopqrstuvwxyzµμÅ ")
    unit = text[len(number) :].strip()
    scales = {"nm": 1e-9, "m": 1.0, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "μm": 1e-6, "pm": 1e-12, "angstrom": 1e-10, "Å": 1e-10}
    if unit not in scales:
        raise ValueError(f"{text!r} is no length that a field can be made of")
    return float(number) * scales[unit]
