"""Shapes of lattices and selections of sites; ``a & b``, ``a | b`` and ``~a`` combine them.

Written by generate.py from the schema of a config; change that, not this.
"""

from __future__ import annotations

from collections.abc import Sequence

from numpy.typing import ArrayLike

from ._values import Extent, Shape

__all__ = [
    "box",
    "disc",
    "ellipse",
    "polygon",
    "ring",
    "image",
    "all_",
    "any_",
    "not_",
]


def box(
    from_: Sequence[Extent],
    to: Sequence[Extent],
) -> Shape:
    """Between two corners.

    Parameters
    ----------
    from_
        The one of least coordinates.
    to
        The one of greatest coordinates.
    """
    return Shape("box", {"from": from_, "to": to})


def disc(
    radius: Extent,
    *,
    center: Sequence[Extent] | None = None,
) -> Shape:
    """Within a distance, of any z.

    Parameters
    ----------
    radius
        Largest distance.
    center
        The middle of the box of all sites if not given.
    """
    return Shape("disc", {"radius": radius, "center": center})


def ellipse(
    semi_axes: Sequence[Extent],
    *,
    center: Sequence[Extent] | None = None,
) -> Shape:
    """Within an ellipse of any z, or an ellipsoid.

    Parameters
    ----------
    semi_axes
        Two, or three of an ellipsoid.
    center
        The middle of the box of all sites if not given.
    """
    return Shape("ellipse", {"semi_axes": semi_axes, "center": center})


def polygon(
    values: ArrayLike,
) -> Shape:
    """Inside a polygon, of any z.
    """
    return Shape("polygon", values)


def ring(
    inner: Extent,
    outer: Extent,
    *,
    center: Sequence[Extent] | None = None,
) -> Shape:
    """Between two distances, of any z.

    Parameters
    ----------
    inner
        Least distance.
    outer
        Largest distance.
    center
        The middle of the box of all sites if not given.
    """
    return Shape("ring", {"inner": inner, "outer": outer, "center": center})


def image(
    path: str,
) -> Shape:
    """The dark pixels of an image laid over all sites, of any z.

    Parameters
    ----------
    path
        A PNG image beside the config, or a data URL.
    """
    return Shape("image", {"path": path})


def all_(
    *shapes: Shape,
) -> Shape:
    """In all of these.
    """
    return Shape("all", list(shapes))


def any_(
    *shapes: Shape,
) -> Shape:
    """In any of these.
    """
    return Shape("any", list(shapes))


def not_(
    shape: Shape,
) -> Shape:
    """Not in this.
    """
    return Shape("not", shape)
