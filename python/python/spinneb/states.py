"""Spin states, for the ends of a path and on its way.

Written by generate.py from the schema of a config; change that, not this.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from numpy.typing import ArrayLike

from ._values import Direction, Extent, State, as_count, as_direction

__all__ = [
    "uniform",
    "domain_wall",
    "soliton",
    "skyrmion",
    "vortex",
    "spiral",
    "random",
    "vectors",
    "file",
    "regions",
]


def uniform(
    direction: Direction,
    *,
    staggered: bool | None = None,
) -> State:
    """All spins along one direction.

    Parameters
    ----------
    direction
        Where the spins point.
    staggered
        Reverse odd sites, of a cell with several atoms every other one. Default: false.

    In a config: ``{"uniform": {"direction": [0, 0, 1]}}``
    """
    return State("uniform", {"direction": as_direction(direction, "direction"), "staggered": staggered})


def domain_wall(
    center: Extent,
    *,
    left: Direction | None = None,
    normal: Direction | None = None,
    right: Direction | None = None,
    staggered: bool | None = None,
    through: Literal["auto"] | Direction | None = None,
    width: Extent | None = None,
) -> State:
    """A wall at `center` (in sites) between two domains.

    Parameters
    ----------
    center
        In sites, 39.5 lies between sites 39 and 40: how far the wall is from the origin along its normal.
    left
        Left of the wall; +z if absent.
    normal
        From left to right, across the wall; +x if absent, in a chain along the chain.
    right
        Right of the wall; −z if absent.
    staggered
        Reverse odd sites, of a cell with several atoms every other one. Default: false.
    through
        Where the wall passes; "auto" (or absent): the shorter way, and between opposite domains the cheapest
        for the energy.
    width
        Width δ of the wall in sites; that of the material if absent. 0 is an abrupt wall.

    In a config: ``{"domain_wall": {"center": 5.5, "through": [0, 1, 0], "width": 2}}``
    """
    return State("domain_wall", {"center": center, "left": as_direction(left, "left"), "normal": as_direction(normal, "normal"), "right": as_direction(right, "right"), "staggered": staggered, "through": as_direction(through, "through", "auto"), "width": width})


def soliton(
    center: Extent,
    *,
    domain: Direction | None = None,
    normal: Direction | None = None,
    staggered: bool | None = None,
    through: Literal["auto"] | Direction | None = None,
    width: Extent | None = None,
) -> State:
    """A 2π wall at `center` (in sites), as in monoaxial helimagnets.

    Parameters
    ----------
    center
        In sites, 39.5 lies between sites 39 and 40: how far the soliton is from the origin along its normal.
    domain
        Where the spins point on both sides; +z if absent.
    normal
        From left to right, across the soliton; +x if absent, in a chain along the chain.
    staggered
        Reverse odd sites, of a cell with several atoms every other one. Default: false.
    through
        Where the spins point a quarter of the way; "auto" (or absent): the cheapest for the energy.
    width
        Width w of the turn in sites; that of the energy if absent. 0 is an abrupt turn.

    In a config: ``{"soliton": {"center": 5.5, "domain": [0, 0, 1], "width": 1.5}}``
    """
    return State("soliton", {"center": center, "domain": as_direction(domain, "domain"), "normal": as_direction(normal, "normal"), "staggered": staggered, "through": as_direction(through, "through", "auto"), "width": width})


def skyrmion(
    *,
    center: Sequence[Extent] | None = None,
    core: Direction | None = None,
    helicity: Literal["auto"] | str | None = None,
    radius: Extent | None = None,
    staggered: bool | None = None,
    vorticity: int | None = None,
    width: Extent | None = None,
) -> State:
    """A skyrmion or an antiskyrmion, a tube in three dimensions.

    Parameters
    ----------
    center
        Where it is; in the middle if absent, on a film that is periodic both ways at the site nearest to
        that.
    core
        Direction of the core; −z if absent. The background is opposite.
    helicity
        Angle from the way outwards to the spins in the wall; "auto" (or absent): of 0, 180°, 90° and −90° the
        cheapest for the energy.
    radius
        Radius R in spacings, where the spins are across core and background; that of the energy if absent.
    staggered
        Reverse odd sites, of a cell with several atoms every other one. Default: false.
    vorticity
        How often the spins turn on the way around; −1 is an antiskyrmion. Default: 1.
    width
        Width w of its wall in spacings; that of the energy if absent. 0 is an abrupt wall.

    In a config: ``{"skyrmion": {"center": [5, 0], "helicity": "90 deg", "radius": 3, "width": 1.5}}``
    """
    return State("skyrmion", {"center": center, "core": as_direction(core, "core"), "helicity": helicity, "radius": radius, "staggered": staggered, "vorticity": as_count(vorticity, "vorticity"), "width": width})


def vortex(
    *,
    center: Sequence[Extent] | None = None,
    core: Direction | None = None,
    helicity: Literal["auto"] | str | None = None,
    radius: Extent | None = None,
    staggered: bool | None = None,
    vorticity: int | None = None,
) -> State:
    """A vortex or an antivortex, with a core out of the plane.

    Parameters
    ----------
    center
        Where it is; in the middle if absent.
    core
        Direction of the core; +z if absent.
    helicity
        Angle from the way outwards to the spins; "auto" (or absent): of 90°, −90°, 0 and 180° the cheapest
        for the energy.
    radius
        A, the radius of the core, in spacings; that of least energy if absent. 0: no core.
    staggered
        Reverse odd sites, of a cell with several atoms every other one. Default: false.
    vorticity
        How often the spins turn on the way around; −1 is an antivortex. Default: 1.

    In a config: ``{"vortex": {"center": [5.5, 0], "core": [0, 0, -1], "radius": 2}}``
    """
    return State("vortex", {"center": center, "core": as_direction(core, "core"), "helicity": helicity, "radius": radius, "staggered": staggered, "vorticity": as_count(vorticity, "vorticity")})


def spiral(
    axis: Direction,
    period: Extent,
    *,
    along: Direction | None = None,
    phase: str | None = None,
    staggered: bool | None = None,
) -> State:
    """Spins that turn about an axis, a full turn in `period` sites.

    Parameters
    ----------
    axis
        Axis k of the turn.
    period
        Sites a full turn; negative turns the other way.
    along
        Where the turn goes; +x if absent, in a chain along the chain.
    phase
        Angle at the origin.
    staggered
        Reverse odd sites, of a cell with several atoms every other one. Default: false.

    In a config: ``{"spiral": {"axis": [0, 1, 0], "period": 20, "phase": "30 deg"}}``
    """
    return State("spiral", {"axis": as_direction(axis, "axis"), "period": period, "along": as_direction(along, "along"), "phase": phase, "staggered": staggered})


def random(
    seed: int,
    *,
    staggered: bool | None = None,
) -> State:
    """Directions spread evenly over the sphere, from a seed.

    Parameters
    ----------
    seed
        Seed of the ChaCha8 generator.
    staggered
        Reverse odd sites, of a cell with several atoms every other one. Default: false.

    In a config: ``{"random": {"seed": 1}}``
    """
    return State("random", {"seed": as_count(seed, "seed", 0), "staggered": staggered})


def vectors(
    values: ArrayLike,
) -> State:
    """Vectors as listed, one a site.

    In a config: ``{"vectors": [[0, 0, 1], [1, 0, 1], [0, 0, -1]]}``
    """
    return State("vectors", values)


def file(
    path: str,
    *,
    segment: int | None = None,
    staggered: bool | None = None,
) -> State:
    """Spins from a file beside the config (OVF 2.0, npz, npy, csv).

    Parameters
    ----------
    path
        The file, looked for beside the config.
    segment
        Which image of several, counted from 0; from the end if negative, −1 the last.
    staggered
        Reverse odd sites, of a cell with several atoms every other one. Default: false.

    In a config: ``{"file": {"path": "relaxed.ovf", "segment": 0}}``
    """
    return State("file", {"path": path, "segment": as_count(segment, "segment"), "staggered": staggered})


def regions(
    default: State,
    **regions: State,
) -> State:
    """A state for each of some regions of the lattice, and one for the rest.

    Parameters
    ----------
    default
        That of all sites in no region.
    regions
        By name of the region.

    In a config: ``{"regions": {"default": {"uniform": {"direction": [0, 0, 1]}}, "island": {"uniform": {"direction": [0, 0, -1]}}}}``
    """
    return State("regions", {"default": default, **regions})
