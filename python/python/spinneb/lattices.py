"""Lattices: where the spins are.

Written by generate.py from the schema of a config; change that, not this.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from ._values import Direction, Lattice, Selection, Shape, Values, as_cells, as_count, as_direction, as_list

__all__ = [
    "chain",
    "square",
    "triangular",
    "honeycomb",
    "kagome",
    "cubic",
    "bcc",
    "fcc",
    "hcp",
    "crystal",
    "grid",
]


def chain(
    sites: int,
    *,
    cross_section: Values | None = None,
    direction: Direction | None = None,
    frozen: Sequence[Mapping[str, Any]] | None = None,
    moments: Sequence[Mapping[str, Any]] | None = None,
    periodic: bool | None = None,
    regions: Mapping[str, Any] | None = None,
    sections: Sequence[Mapping[str, Any]] | None = None,
    spacing: str | None = None,
    vacant: Selection | None = None,
) -> Lattice:
    """A row of equally spaced sites, open or closed to a ring.

    Parameters
    ----------
    sites
        Number of sites.
    cross_section
        Width and thickness of a cell; with the spacing they give its volume. Either may be a list over sites
        or a ramp.
    direction
        Where the chain points; +x if not given.
    frozen
        Spins that never move.
    moments
        Sites whose moment is not the material's.
    periodic
        A ring: the last site is joined to the first. Default: false.
    regions
        Sites with a name, to be chosen by it, and to be made of another material.
    sections
        Sites whose cells are narrower or wider than that: notches, tapers, constrictions.
    spacing
        Distance between neighbours.
    vacant
        Sites without a spin: nothing acts on them, and they on nothing.

    In a config: ``{"chain": {"sites": 100, "spacing": "0.25 nm"}}``
    """
    return Lattice("chain", {"sites": as_count(sites, "sites", 1), "cross_section": as_list(cross_section), "direction": as_direction(direction, "direction"), "frozen": frozen, "moments": moments, "periodic": periodic, "regions": regions, "sections": sections, "spacing": spacing, "vacant": vacant})


def square(
    *cells: int | Sequence[int],
    frozen: Sequence[Mapping[str, Any]] | None = None,
    moments: Sequence[Mapping[str, Any]] | None = None,
    periodic: bool | Sequence[bool] | None = None,
    regions: Mapping[str, Any] | None = None,
    shape: Shape | None = None,
    spacing: str | None = None,
    vacant: Selection | None = None,
) -> Lattice:
    """A square lattice in the plane, one site a cell.

    Parameters
    ----------
    cells
        Cells along each direction.
    frozen
        Spins that never move.
    moments
        Sites whose moment is not the material's.
    periodic
        Whether the last cell in a direction is followed by the first: a flag a direction, or one for all.
    regions
        Sites with a name, to be chosen by it, and to be made of another material.
    shape
        Sites outside do not exist; all are there if not given.
    spacing
        The lattice constant |a₁|; needed only where lengths are.
    vacant
        Sites without a spin: nothing acts on them, and they on nothing.

    In a config: ``{"square": {"cells": [20, 20], "periodic": [true, true]}}``
    """
    return Lattice("square", {"cells": as_cells(cells), "frozen": frozen, "moments": moments, "periodic": periodic, "regions": regions, "shape": shape, "spacing": spacing, "vacant": vacant})


def triangular(
    *cells: int | Sequence[int],
    frozen: Sequence[Mapping[str, Any]] | None = None,
    moments: Sequence[Mapping[str, Any]] | None = None,
    periodic: bool | Sequence[bool] | None = None,
    regions: Mapping[str, Any] | None = None,
    shape: Shape | None = None,
    spacing: str | None = None,
    vacant: Selection | None = None,
) -> Lattice:
    """A triangular lattice in the plane, one site a cell.

    Parameters
    ----------
    cells
        Cells along each direction.
    frozen
        Spins that never move.
    moments
        Sites whose moment is not the material's.
    periodic
        Whether the last cell in a direction is followed by the first: a flag a direction, or one for all.
    regions
        Sites with a name, to be chosen by it, and to be made of another material.
    shape
        Sites outside do not exist; all are there if not given.
    spacing
        The lattice constant |a₁|; needed only where lengths are.
    vacant
        Sites without a spin: nothing acts on them, and they on nothing.

    In a config: ``{"triangular": {"cells": [20, 20], "periodic": [true, true]}}``
    """
    return Lattice("triangular", {"cells": as_cells(cells), "frozen": frozen, "moments": moments, "periodic": periodic, "regions": regions, "shape": shape, "spacing": spacing, "vacant": vacant})


def honeycomb(
    *cells: int | Sequence[int],
    frozen: Sequence[Mapping[str, Any]] | None = None,
    moments: Sequence[Mapping[str, Any]] | None = None,
    periodic: bool | Sequence[bool] | None = None,
    regions: Mapping[str, Any] | None = None,
    shape: Shape | None = None,
    spacing: str | None = None,
    vacant: Selection | None = None,
) -> Lattice:
    """A honeycomb lattice in the plane, two sites a cell.

    Parameters
    ----------
    cells
        Cells along each direction.
    frozen
        Spins that never move.
    moments
        Sites whose moment is not the material's.
    periodic
        Whether the last cell in a direction is followed by the first: a flag a direction, or one for all.
    regions
        Sites with a name, to be chosen by it, and to be made of another material.
    shape
        Sites outside do not exist; all are there if not given.
    spacing
        The lattice constant |a₁|; needed only where lengths are.
    vacant
        Sites without a spin: nothing acts on them, and they on nothing.

    In a config: ``{"honeycomb": {"cells": [14, 14], "periodic": [true, true]}}``
    """
    return Lattice("honeycomb", {"cells": as_cells(cells), "frozen": frozen, "moments": moments, "periodic": periodic, "regions": regions, "shape": shape, "spacing": spacing, "vacant": vacant})


def kagome(
    *cells: int | Sequence[int],
    frozen: Sequence[Mapping[str, Any]] | None = None,
    moments: Sequence[Mapping[str, Any]] | None = None,
    periodic: bool | Sequence[bool] | None = None,
    regions: Mapping[str, Any] | None = None,
    shape: Shape | None = None,
    spacing: str | None = None,
    vacant: Selection | None = None,
) -> Lattice:
    """A kagome lattice in the plane, three sites a cell.

    Parameters
    ----------
    cells
        Cells along each direction.
    frozen
        Spins that never move.
    moments
        Sites whose moment is not the material's.
    periodic
        Whether the last cell in a direction is followed by the first: a flag a direction, or one for all.
    regions
        Sites with a name, to be chosen by it, and to be made of another material.
    shape
        Sites outside do not exist; all are there if not given.
    spacing
        The lattice constant |a₁|; needed only where lengths are.
    vacant
        Sites without a spin: nothing acts on them, and they on nothing.

    In a config: ``{"kagome": {"cells": [10, 10], "periodic": [true, true]}}``
    """
    return Lattice("kagome", {"cells": as_cells(cells), "frozen": frozen, "moments": moments, "periodic": periodic, "regions": regions, "shape": shape, "spacing": spacing, "vacant": vacant})


def cubic(
    *cells: int | Sequence[int],
    frozen: Sequence[Mapping[str, Any]] | None = None,
    moments: Sequence[Mapping[str, Any]] | None = None,
    periodic: bool | Sequence[bool] | None = None,
    regions: Mapping[str, Any] | None = None,
    shape: Shape | None = None,
    spacing: str | None = None,
    vacant: Selection | None = None,
) -> Lattice:
    """A simple cubic lattice, one site a cell.

    Parameters
    ----------
    cells
        Cells along each direction.
    frozen
        Spins that never move.
    moments
        Sites whose moment is not the material's.
    periodic
        Whether the last cell in a direction is followed by the first: a flag a direction, or one for all.
    regions
        Sites with a name, to be chosen by it, and to be made of another material.
    shape
        Sites outside do not exist; all are there if not given.
    spacing
        The lattice constant |a₁|; needed only where lengths are.
    vacant
        Sites without a spin: nothing acts on them, and they on nothing.

    In a config: ``{"cubic": {"cells": [8, 8, 8]}}``
    """
    return Lattice("cubic", {"cells": as_cells(cells), "frozen": frozen, "moments": moments, "periodic": periodic, "regions": regions, "shape": shape, "spacing": spacing, "vacant": vacant})


def bcc(
    *cells: int | Sequence[int],
    frozen: Sequence[Mapping[str, Any]] | None = None,
    moments: Sequence[Mapping[str, Any]] | None = None,
    periodic: bool | Sequence[bool] | None = None,
    regions: Mapping[str, Any] | None = None,
    shape: Shape | None = None,
    spacing: str | None = None,
    vacant: Selection | None = None,
) -> Lattice:
    """A body-centred cubic lattice, two sites a cube.

    Parameters
    ----------
    cells
        Cells along each direction.
    frozen
        Spins that never move.
    moments
        Sites whose moment is not the material's.
    periodic
        Whether the last cell in a direction is followed by the first: a flag a direction, or one for all.
    regions
        Sites with a name, to be chosen by it, and to be made of another material.
    shape
        Sites outside do not exist; all are there if not given.
    spacing
        The lattice constant |a₁|; needed only where lengths are.
    vacant
        Sites without a spin: nothing acts on them, and they on nothing.

    In a config: ``{"bcc": {"cells": [8, 8, 8]}}``
    """
    return Lattice("bcc", {"cells": as_cells(cells), "frozen": frozen, "moments": moments, "periodic": periodic, "regions": regions, "shape": shape, "spacing": spacing, "vacant": vacant})


def fcc(
    *cells: int | Sequence[int],
    frozen: Sequence[Mapping[str, Any]] | None = None,
    moments: Sequence[Mapping[str, Any]] | None = None,
    periodic: bool | Sequence[bool] | None = None,
    regions: Mapping[str, Any] | None = None,
    shape: Shape | None = None,
    spacing: str | None = None,
    vacant: Selection | None = None,
) -> Lattice:
    """A face-centred cubic lattice, four sites a cube.

    Parameters
    ----------
    cells
        Cells along each direction.
    frozen
        Spins that never move.
    moments
        Sites whose moment is not the material's.
    periodic
        Whether the last cell in a direction is followed by the first: a flag a direction, or one for all.
    regions
        Sites with a name, to be chosen by it, and to be made of another material.
    shape
        Sites outside do not exist; all are there if not given.
    spacing
        The lattice constant |a₁|; needed only where lengths are.
    vacant
        Sites without a spin: nothing acts on them, and they on nothing.

    In a config: ``{"fcc": {"cells": [8, 8, 8]}}``
    """
    return Lattice("fcc", {"cells": as_cells(cells), "frozen": frozen, "moments": moments, "periodic": periodic, "regions": regions, "shape": shape, "spacing": spacing, "vacant": vacant})


def hcp(
    *cells: int | Sequence[int],
    c_over_a: float | None = None,
    frozen: Sequence[Mapping[str, Any]] | None = None,
    moments: Sequence[Mapping[str, Any]] | None = None,
    periodic: bool | Sequence[bool] | None = None,
    regions: Mapping[str, Any] | None = None,
    shape: Shape | None = None,
    spacing: str | None = None,
    vacant: Selection | None = None,
) -> Lattice:
    """A hexagonal close-packed lattice, two sites a cell.

    Parameters
    ----------
    cells
        Cells along each direction.
    c_over_a
        Height of the cell over its edge; that of close-packed spheres, √(8/3), if not given.
    frozen
        Spins that never move.
    moments
        Sites whose moment is not the material's.
    periodic
        Whether the last cell in a direction is followed by the first: a flag a direction, or one for all.
    regions
        Sites with a name, to be chosen by it, and to be made of another material.
    shape
        Sites outside do not exist; all are there if not given.
    spacing
        The lattice constant |a₁|; needed only where lengths are.
    vacant
        Sites without a spin: nothing acts on them, and they on nothing.

    In a config: ``{"hcp": {"c_over_a": 1.62, "cells": [6, 6, 4]}}``
    """
    return Lattice("hcp", {"cells": as_cells(cells), "c_over_a": c_over_a, "frozen": frozen, "moments": moments, "periodic": periodic, "regions": regions, "shape": shape, "spacing": spacing, "vacant": vacant})


def crystal(
    *cells: int | Sequence[int],
    vectors: Sequence[Sequence[float]],
    basis: Sequence[Mapping[str, Any]],
    frozen: Sequence[Mapping[str, Any]] | None = None,
    moments: Sequence[Mapping[str, Any]] | None = None,
    periodic: bool | Sequence[bool] | None = None,
    regions: Mapping[str, Any] | None = None,
    shape: Shape | None = None,
    spacing: str | None = None,
    vacant: Selection | None = None,
) -> Lattice:
    """Any crystal, from the vectors of its cell and the atoms in it.

    Parameters
    ----------
    cells
        Cells along each direction.
    vectors
        The vectors of the cell, in units of `spacing`.
    basis
        Its atoms.
    frozen
        Spins that never move.
    moments
        Sites whose moment is not the material's.
    periodic
        Whether the last cell in a direction is followed by the first: a flag a direction, or one for all.
    regions
        Sites with a name, to be chosen by it, and to be made of another material.
    shape
        Sites outside do not exist; all are there if not given.
    spacing
        The lattice constant |a₁|; needed only where lengths are.
    vacant
        Sites without a spin: nothing acts on them, and they on nothing.

    In a config: ``{"crystal": {"basis": [{"at": [0, 0, 0], "species": "Fe"}, {"at": [0.5, 0.5, 0.5], "species": "Pt"}], "cells": [4, 4, 2], "vectors": [[1, 0, 0], [0, 1, 0], [0, 0, 0.9]]}}``
    """
    return Lattice("crystal", {"cells": as_cells(cells), "vectors": vectors, "basis": basis, "frozen": frozen, "moments": moments, "periodic": periodic, "regions": regions, "shape": shape, "spacing": spacing, "vacant": vacant})


def grid(
    *cells: int | Sequence[int],
    cell: Sequence[str],
    frozen: Sequence[Mapping[str, Any]] | None = None,
    moments: Sequence[Mapping[str, Any]] | None = None,
    periodic: bool | Sequence[bool] | None = None,
    regions: Mapping[str, Any] | None = None,
    shape: Shape | None = None,
    vacant: Selection | None = None,
) -> Lattice:
    """Cells of a continuum in a box.

    Parameters
    ----------
    cells
        Cells along x, y and z.
    cell
        Edges of a cell.
    frozen
        Spins that never move.
    moments
        Cells whose moment is not the material's.
    periodic
        Whether the last cell in a direction is followed by the first: a flag a direction, or one for all.
    regions
        Cells with a name, to be chosen by it, and to be made of another material.
    shape
        Cells outside do not exist; all are there if not given.
    vacant
        Cells without a spin: nothing acts on them, and they on nothing.

    In a config: ``{"grid": {"cell": ["2 nm", "2 nm", "0.6 nm"], "cells": [40, 40, 1]}}``
    """
    return Lattice("grid", {"cells": as_cells(cells), "cell": cell, "frozen": frozen, "moments": moments, "periodic": periodic, "regions": regions, "shape": shape, "vacant": vacant})
