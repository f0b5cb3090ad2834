"""First guesses of a path.

Written by generate.py from the schema of a config; change that, not this.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from ._values import AnyState, Direction, Extent, Guess, as_direction, as_states

__all__ = [
    "geodesic",
    "sweep",
    "shrink",
    "drift",
    "translation",
    "droplet",
    "rotation",
    "nlerp",
    "waypoints",
    "file",
]


def geodesic(
    *,
    axis: Direction | None = None,
) -> Guess:
    """Every spin along its great circle (slerp), opposite ones about one axis.

    Parameters
    ----------
    axis
        Axis about which opposite spins turn.

    In a config: ``{"geodesic": {"axis": [1, 0, 0]}}``
    """
    return Guess("geodesic", {"axis": as_direction(axis, "axis")})


def sweep(
    from_: Literal["left", "right", "center", "ends", "edges", "corners"] | Direction,
    *,
    axis: Direction | None = None,
    helicity: str | None = None,
    rigid: bool | None = None,
    width: Extent | None = None,
) -> Guess:
    """A front enters from a side (left, right or any direction), from the center, from all edges or corners.

    Parameters
    ----------
    from_
        Where the front enters: "left", "right", "center", "ends", "edges" or "corners", or the direction of
        the side.
    axis
        Axis about which opposite spins turn.
    helicity
        In place of an axis: opposite spins turn by way of the direction at this angle to the way of the
        front.
    rigid
        All spins turn as one about the axis (that of the best rotation if absent), not each along its own
        great circle. Default: false.
    width
        Its width in sites; four times δ of the material if absent.

    In a config: ``{"sweep": {"from": "left", "width": 4}}``
    """
    return Guess("sweep", {"from": as_direction(from_, "from_", "left", "right", "center", "ends", "edges", "corners"), "axis": as_direction(axis, "axis"), "helicity": helicity, "rigid": rigid, "width": width})


def shrink(
    *,
    axis: Direction | None = None,
    center: Sequence[Extent] | None = None,
    helicity: str | None = None,
    rigid: bool | None = None,
    width: Extent | None = None,
) -> Guess:
    """A round front closes on a point: a skyrmion shrinks to nothing.

    Parameters
    ----------
    axis
        Axis about which opposite spins turn.
    center
        Where it closes; at the hollow nearest to the middle of what differs if absent.
    helicity
        In place of an axis: opposite spins turn by way of the direction at this angle to the way of the
        front.
    rigid
        All spins turn as one about the axis (that of the best rotation if absent), not each along its own
        great circle. Default: false.
    width
        Width of the front in sites; four times δ of the material if absent.

    In a config: ``{"shrink": {"center": [5.5, 0]}}``
    """
    return Guess("shrink", {"axis": as_direction(axis, "axis"), "center": center, "helicity": helicity, "rigid": rigid, "width": width})


def drift(
    *,
    direction: Direction | None = None,
    onto: Sequence[Extent] | None = None,
) -> Guess:
    """What differs is carried off over an edge: a skyrmion leaves the film.

    Parameters
    ----------
    direction
        Where it goes; to the nearest edge if absent.
    onto
        In place of a direction: the middle of a hole, or any place, where it goes out.

    In a config: ``{"drift": {"direction": [1, 0, 0]}}``
    """
    return Guess("drift", {"direction": as_direction(direction, "direction"), "onto": onto})


def translation() -> Guess:
    """What is in one place in the initial state is carried to its place in the final one: a skyrmion moves
    along a track.

    In a config: ``{"translation": {}}``
    """
    return Guess("translation", {})


def droplet(
    *,
    axis: Direction | None = None,
    center: Sequence[Extent] | None = None,
    helicity: str | None = None,
    of: Literal["initial"] | Literal["final"] | None = None,
    radius: Extent | None = None,
    rigid: bool | None = None,
    width: Extent | None = None,
) -> Guess:
    """A droplet of the final state grows from a point, such as a corner, or one of the initial state shrinks
    to it.

    Parameters
    ----------
    axis
        Axis about which opposite spins turn.
    center
        Where it begins, or ends; at the hollow nearest to the middle of what differs if absent.
    helicity
        In place of an axis: opposite spins turn by way of the direction at this angle to the way of the
        front.
    of
        Which state it is of: the final one grows from the point, the initial one shrinks to it.
    radius
        What turns together, in spacings; 0 if absent.
    rigid
        All spins turn as one about the axis (that of the best rotation if absent), not each along its own
        great circle. Default: false.
    width
        Width of the front in sites; four times δ of the material if absent.

    In a config: ``{"droplet": {"center": [0, 0], "radius": 1}}``
    """
    return Guess("droplet", {"axis": as_direction(axis, "axis"), "center": center, "helicity": helicity, "of": of, "radius": radius, "rigid": rigid, "width": width})


def rotation(
    *,
    axis: Direction | None = None,
) -> Guess:
    """The whole configuration turned rigidly about an axis.

    Parameters
    ----------
    axis
        Axis of the turn; that of the best rotation if absent.

    In a config: ``{"rotation": {"axis": [0, 0, 1]}}``
    """
    return Guess("rotation", {"axis": as_direction(axis, "axis")})


def nlerp(
    *,
    axis: Direction | None = None,
) -> Guess:
    """Components interpolated and normalised, to compare with.

    Parameters
    ----------
    axis
        Axis about which opposite spins turn.

    In a config: ``{"nlerp": {}}``
    """
    return Guess("nlerp", {"axis": as_direction(axis, "axis")})


def waypoints(
    states: Sequence[AnyState],
) -> Guess:
    """Geodesics through given states.

    Parameters
    ----------
    states
        The states on the way, in order; the two ends are not repeated.

    In a config: ``{"waypoints": {"states": [{"domain_wall": {"center": 3}}, {"domain_wall": {"center": 7}}]}}``
    """
    return Guess("waypoints", {"states": as_states(states, "states")})


def file(
    path: str,
) -> Guess:
    """A path from a file beside the config (OVF 2.0, npz, npy, csv).

    Parameters
    ----------
    path
        The file, looked for beside the config.

    In a config: ``{"file": {"path": "earlier/path.npz"}}``
    """
    return Guess("file", {"path": path})
