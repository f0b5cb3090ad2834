"""Energy terms. Every bond counts once; the energies of terms add up.

Written by generate.py from the schema of a config; change that, not this.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

from ._values import Direction, Energy, Selection, Values, as_direction, as_list

__all__ = [
    "exchange",
    "anisotropy",
    "cubic_anisotropy",
    "dmi",
    "pairs",
    "biquadratic",
    "four_spin",
    "zeeman",
    "dipolar",
    "demag",
]


def exchange(
    *,
    A: Values | None = None,
    J: Values | None = None,
    J_area: Values | None = None,
    between: Sequence[Selection] | None = None,
    bonds: Selection | None = None,
    sites: Selection | None = None,
) -> Energy:
    """Heisenberg exchange −J m_i·m_j of any neighbour shells, a stiffness A, or J_area an area between
    layers.

    Parameters
    ----------
    A
        Exchange stiffness of a continuum.
    J
        Bond energies of the nearest, next … neighbours.
    J_area
        Exchange an area of the cross-section, between layers.
    between
        Only bonds from the first of these to the second, with shells of their own.
    bonds
        Only these bonds of a chain (of every shell given); all if absent.
    sites
        Only bonds with both ends among these sites; all if absent.

    In a config: ``{"exchange": {"J": ["10 meV", "-1 meV"]}}``
    """
    return Energy("exchange", {"A": A, "J": as_list(J), "J_area": J_area, "between": between, "bonds": bonds, "sites": sites})


def anisotropy(
    K: Values,
    axis: Direction = "z",
    *,
    K2: Values | None = None,
    sites: Selection | None = None,
) -> Energy:
    """Uniaxial anisotropy −K (m·e)² − K2 (m·e)⁴, K > 0 an easy axis, K < 0 a hard one.

    Parameters
    ----------
    K
        Energy per site or per volume; positive: easy axis.
    axis
        The axis.
    K2
        Fourth-order constant.
    sites
        Only these sites; all if absent.

    In a config: ``{"anisotropy": {"K": "0.5 meV", "K2": "0.1 meV", "axis": [0, 0, 1]}}``
    """
    return Energy("anisotropy", {"K": K, "axis": as_direction(axis, "axis"), "K2": K2, "sites": sites})


def cubic_anisotropy(
    K: Values,
    *,
    axes: Sequence[Direction] | None = None,
    sites: Selection | None = None,
) -> Energy:
    """Cubic anisotropy K (α₁²α₂² + α₂²α₃² + α₃²α₁²).

    Parameters
    ----------
    K
        Energy per site or per volume.
    axes
        Two cube axes at right angles, the third follows; x and y if absent.
    sites
        Only these sites; all if absent.

    In a config: ``{"cubic_anisotropy": {"K": "0.2 meV", "axes": [[1, 1, 0], [-1, 1, 0]]}}``
    """
    return Energy("cubic_anisotropy", {"K": K, "axes": as_direction(axes, "axes"), "sites": sites})


def dmi(
    D: Values,
    *,
    between: Sequence[Selection] | None = None,
    bonds: Selection | None = None,
    direction: Direction | None = None,
    kind: Literal["interfacial"] | Literal["bulk"] | Literal["d2d"] | None = None,
    normal: Direction | None = None,
    sites: Selection | None = None,
) -> Energy:
    """Dzyaloshinskii–Moriya interaction +D d·(m_i × m_j): interfacial, bulk, d2d or of one direction.

    Parameters
    ----------
    D
        Energy per bond, or per area between cells; a list is by shell of neighbours, and in a chain without a
        `kind` by bond.
    between
        Only bonds from the first of these to the second, with shells of their own.
    bonds
        Only these bonds of a chain; all if absent.
    direction
        D̂, the same for all bonds.
    kind
        How d̂ follows from the direction of a bond.
    normal
        The normal n of an interface; ẑ if not given.
    sites
        Only bonds with both ends among these sites; all if absent.

    In a config: ``{"dmi": {"D": "2 meV", "direction": [0, 1, 0]}}``
    """
    return Energy("dmi", {"D": D, "between": between, "bonds": bonds, "direction": as_direction(direction, "direction"), "kind": kind, "normal": as_direction(normal, "normal"), "sites": sites})


def pairs(
    *,
    bonds: Sequence[Mapping[str, Any]] | None = None,
    convention: Mapping[str, Any] | None = None,
    file: str | None = None,
) -> Energy:
    """Single pairs of a cell, each with a J, a vector D and a tensor.

    Parameters
    ----------
    bonds
        The bonds of a cell; each stands once in every cell.
    convention
        What the numbers mean; each pair once, E = −J m_i·m_j + D·(m_i × m_j) − m_iᵀ T m_j, if not given. A
        file has to have it.
    file
        A table of bonds in place of them, beside the config: columns from, to, cell_1 … cell_3, J_meV,
        D_x_meV … T_zz_meV, in any unit of energy.

    In a config: ``{"pairs": {"bonds": [{"D": ["0 meV", "1 meV", "0 meV"], "J": "10 meV", "cell": [1, 0, 0], "from": 0, "to": 0}], "convention": {"counting": "once", "energy": "-J"}}}``
    """
    return Energy("pairs", {"bonds": bonds, "convention": convention, "file": file})


def biquadratic(
    B: Values,
    *,
    between: Sequence[Selection] | None = None,
    sites: Selection | None = None,
) -> Energy:
    """Biquadratic exchange −B (m_i·m_j)² of any neighbour shells.

    Parameters
    ----------
    B
        Energy per bond of the nearest neighbours, or a list by shell.
    between
        Only bonds from the first of these to the second, with shells of their own.
    sites
        Only bonds with both ends among these sites; all if absent.

    In a config: ``{"biquadratic": {"B": ["0.3 meV"]}}``
    """
    return Energy("biquadratic", {"B": B, "between": between, "sites": sites})


def four_spin(
    quads: Sequence[Mapping[str, Any]],
) -> Energy:
    """Exchange −K (m_i·m_j)(m_k·m_l) of four spins, or its ring form.

    Parameters
    ----------
    quads
        The quadruples; each stands once in every cell.

    In a config: ``{"four_spin": {"quads": [{"K": "0.1 meV", "cells": [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0]], "ring": true}]}}``
    """
    return Energy("four_spin", {"quads": quads})


def zeeman(
    B: Sequence[str],
    *,
    sites: Selection | None = None,
) -> Energy:
    """Energy −μ m·B of the moments in a field.

    Parameters
    ----------
    B
        The field's components.
    sites
        Only these sites; all if absent.

    In a config: ``{"zeeman": {"B": ["0 T", "0 T", "-50 mT"]}}``
    """
    return Energy("zeeman", {"B": B, "sites": sites})


def dipolar() -> Energy:
    """Point dipoles, exact for all pairs and, in rings, all images.

    In a config: ``{"dipolar": {}}``
    """
    return Energy("dipolar", {})


def demag() -> Energy:
    """Demagnetising field of uniformly magnetised cells (Newell tensors), all pairs.

    In a config: ``{"demag": {}}``
    """
    return Energy("demag", {})
