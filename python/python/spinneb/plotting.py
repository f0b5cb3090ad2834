"""Figures on matplotlib axes."""

from __future__ import annotations

import colorsys
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
#: blue and vermilion of Okabe and Ito, which all eyes can tell apart
CURVE, TOP = "#0072b2", "#d55e00"
#: rows of sites are drawn as arrows up to so many
_ARROWS = 120


def energy_path(
    profile: tuple[Array, Array],
    images: tuple[Array, Array],
    saddles: Sequence[tuple[float, float]],
    title: str,
    ax: Axes | None = None,
    **style: Any,
) -> Axes:
    """See :meth:`spinneb.Result.plot`; all in radians and meV."""
    import matplotlib.pyplot as plt

    ax = plt.subplots(figsize=(4.8, 3.2), layout="constrained")[1] if ax is None else ax
    style = {"color": CURVE, "linewidth": 1.5, **style}
    (line,) = ax.plot(*profile, **style)
    ax.plot(*images, "o", ms=3.5, color=line.get_color())
    for place, height in saddles:
        ax.plot(place, height, "D", ms=5, color=TOP, zorder=3)
    ax.set_title(title, fontsize="medium")
    ax.set_xlabel("reaction coordinate (rad)")
    ax.set_ylabel("energy above the initial state (meV)")
    return ax


def maps(states: Sequence[Array], places: Array, titles: Sequence[str], axes: Sequence[Axes] | None = None) -> list[Axes]:
    """States side by side: chains one below the other, films as maps of their top layer."""
    import matplotlib.pyplot as plt

    is_row = bool(np.ptp(places[:, 1]) < 1e-9 and np.ptp(places[:, 2]) < 1e-9)
    n = len(states)
    if axes is not None:
        made = list(axes)
    elif is_row:
        made = list(plt.subplots(n, 1, figsize=(6.4, 0.95 * n + 0.4), sharex=True, squeeze=False, layout="constrained")[1][:, 0])
    else:
        made = list(plt.subplots(1, n, figsize=(2.9 * n, 3.1), squeeze=False, layout="constrained")[1][0])
    if len(made) < n:
        raise ValueError(f"found {len(made)} axes for {n} states")
    for ax, m, title in zip(made, states, titles):
        (_row if is_row else _film)(ax, m, places)
        ax.set_title(title, fontsize="small")
    return made


def colors(m: Array) -> Array:
    """Colours of directions: hue for the angle in the plane, lightness for m_z; white up, black down."""
    hue = (np.arctan2(m[:, 1], m[:, 0]) / (2 * np.pi)) % 1.0
    light = 0.5 + 0.5 * np.clip(m[:, 2], -1, 1)
    return np.array([colorsys.hls_to_rgb(h, 0.06 + 0.9 * x, 0.95 * np.hypot(a, b)) for h, x, a, b in zip(hue, light, m[:, 0], m[:, 1])])


def _row(ax: Axes, m: Array, places: Array) -> None:
    x = places[:, 0]
    step = max(1, int(np.ceil(len(m) / _ARROWS)))
    x, m = x[::step], m[::step]
    span = max(float(np.ptp(x)), 1.0)
    # arrows in the plane of the chain and z, what points out of it by its colour
    ax.quiver(x, 0 * x, m[:, 0], m[:, 2], color=colors(m), pivot="mid", units="width", scale=float(np.clip(0.6 * len(x), 14, 45)), width=0.0045, edgecolor="0.3", linewidth=0.3)
    ax.set_xlim(x.min() - 0.03 * span, x.max() + 0.03 * span)
    ax.set_ylim(-1, 1)
    ax.set_yticks([])
    ax.set_xlabel("site")
    ax.label_outer()


def _film(ax: Axes, m: Array, places: Array) -> None:
    from matplotlib.collections import PolyCollection

    top = places[:, 2] > places[:, 2].max() - 1e-6
    m, r = m[top], places[top][:, :2]
    ax.set_aspect("equal")
    distance = nearest(r)
    turn = np.arange(6) * np.pi / 3 + np.pi / 6
    corner = 0.58 * distance * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    square = 0.5 * distance * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    cell = square if _is_square(r, distance) else corner
    ax.add_collection(PolyCollection(r[:, None, :] + cell[None], facecolors=colors(m), edgecolors="none"))
    ax.set_facecolor("0.93")
    pad = 0.7 * distance
    ax.set_xlim(r[:, 0].min() - pad, r[:, 0].max() + pad)
    ax.set_ylim(r[:, 1].min() - pad, r[:, 1].max() + pad)
    ax.set_xticks([])
    ax.set_yticks([])


def nearest(r: Array) -> float:
    """The distance of nearest neighbours, from some sites."""
    some = r[:: max(1, len(r) // 50)]
    d = np.linalg.norm(some[:, None] - r[None], axis=-1)
    d[d < 1e-9] = np.inf
    found = float(d.min()) if len(r) > 1 else 1.0
    return found if np.isfinite(found) else 1.0


def _is_square(r: Array, distance: float) -> bool:
    """Whether neighbours stand along x and y alone."""
    middle = r[len(r) // 2]
    way = r - middle
    near = way[np.abs(np.linalg.norm(way, axis=1) - distance) < 1e-6]
    return bool(np.all(np.min(np.abs(near), axis=1) < 1e-6))


def lifetimes(temperatures_K: Array, log10_s: Array, low: NDArray[np.bool_], ax: Axes | None = None, **style: Any) -> Axes:
    """See :meth:`spinneb.Rates.plot`."""
    import matplotlib.pyplot as plt

    ax = plt.subplots(figsize=(4.8, 3.2), layout="constrained")[1] if ax is None else ax
    style = {"color": CURVE, "marker": "o", "ms": 4, **style}
    ax.plot(temperatures_K, np.where(low, np.nan, log10_s), **style)
    # the grey line reaches to the first point of the other
    reach = low.copy()
    reach[1:] |= low[:-1]
    reach[:-1] |= low[1:]
    if low.any():
        ax.plot(temperatures_K, np.where(reach, log10_s, np.nan), **{**style, "color": "0.6", "zorder": 1, "label": "barrier below 5 kT"})
    ax.set_xlabel("temperature (K)")
    ax.set_ylabel("log₁₀ lifetime (s)")
    for seconds, words in [(0.0, "1 s"), (np.log10(10 * 365.25 * 86400), "10 years")]:
        bottom, top = ax.get_ylim()
        if bottom < seconds < top:
            ax.axhline(seconds, color="0.7", lw=0.8, zorder=0)
            ax.annotate(words, (1, seconds), xycoords=("axes fraction", "data"), ha="right", va="bottom", fontsize="small", color="0.4")
    return ax
