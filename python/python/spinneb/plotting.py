"""Figures on matplotlib axes."""

from __future__ import annotations

import colorsys
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._optional import needs

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Array = NDArray[np.float64]
#: blue and vermilion of Okabe and Ito, which all eyes can tell apart
CURVE, TOP = "#0072b2", "#d55e00"
#: lifetimes that are drawn (s), as in arrhenius.png
SHORTEST_S, LONGEST_S = 1e-15, 1e25
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
    needs("matplotlib")
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


def maps(
    states: Sequence[Array],
    places: Array,
    vacant: NDArray[np.bool_],
    titles: Sequence[str],
    axes: Sequence[Axes] | None = None,
    key: Axes | None = None,
) -> list[Axes]:
    """States side by side: chains one below the other, films as maps of their top layer; sites without a spin are left blank; a figure of
    its own has a key of the colours."""
    is_row = bool(np.ptp(places[:, 1]) < 1e-9 and np.ptp(places[:, 2]) < 1e-9)
    made, key = _figure(len(states), places, is_row) if axes is None else (list(axes), key)
    if len(made) < len(states):
        raise ValueError(f"found {len(made)} axes for {len(states)} states")
    for ax, m, title in zip(made, states, titles):
        (_row if is_row else _film)(ax, m, places, vacant)
        ax.set_title(title, fontsize="small")
    if key is not None:
        wheel(key, "arrows: $m_x$ →, $m_z$ ↑" if is_row else "")
    return made


def _figure(n: int, places: Array, is_row: bool) -> tuple[list[Axes], Axes]:
    """Axes of n states, and beside them those of the key."""
    needs("matplotlib")
    import matplotlib.pyplot as plt

    if is_row:
        figure = plt.figure(figsize=(7.6, max(0.95 * n + 0.4, 2.0)), layout="constrained")
        grid = figure.add_gridspec(n, 2, width_ratios=[6.4, 1.2])
        made = [figure.add_subplot(grid[0, 0])]
        made += [figure.add_subplot(grid[k, 0], sharex=made[0]) for k in range(1, n)]
        return made, figure.add_subplot(grid[:, 1])
    wide, high = (float(np.ptp(places[:, k])) + nearest(places) for k in (0, 1))
    figure = plt.figure(figsize=(2.9 * n + 1.2, max(min(2.9 * high / wide, 5.8) + 0.5, 2.0)), layout="constrained")
    grid = figure.add_gridspec(1, n + 1, width_ratios=[2.9] * n + [1.2])
    *made, key = (figure.add_subplot(grid[0, k]) for k in range(n + 1))
    return made, key


def wheel(ax: Axes, below: str = "") -> None:
    """All colours: the direction in the plane around the middle, where m_z is 1; at the rim it is −1."""
    side = np.linspace(-1, 1, 201)
    x, y = np.meshgrid(side, side)
    out = np.hypot(x, y)
    z = np.clip(1 - 2 * out, -1, 1)
    across = np.sqrt(1 - z * z) / np.maximum(out, 1e-9)
    shown = colors(np.stack([across * x, across * y, z], axis=-1).reshape(-1, 3)).reshape(*x.shape, 3)
    ax.imshow(np.dstack([shown, out <= 1]), origin="lower", extent=(-1, 1, -1, 1), interpolation="bilinear")
    ax.set_axis_off()
    ax.set_anchor("C")
    for words, place, align in [("+x", (1.05, 0), ("left", "center")), ("+y", (0, 1.05), ("center", "bottom"))]:
        ax.text(*place, words, ha=align[0], va=align[1], fontsize="small")
    words = "\n".join(["centre $m_z$ = 1,", "rim $m_z$ = −1", *([below] if below else [])])
    ax.text(0, -1.1, words, ha="center", va="top", fontsize="small", linespacing=1.4)


def colors(m: Array) -> Array:
    """Colours of directions: hue for the angle in the plane, lightness for m_z; white up, black down."""
    hue = (np.arctan2(m[:, 1], m[:, 0]) / (2 * np.pi)) % 1.0
    light = 0.5 + 0.5 * np.clip(m[:, 2], -1, 1)
    return np.array([colorsys.hls_to_rgb(h, 0.06 + 0.9 * x, 0.95 * np.hypot(a, b)) for h, x, a, b in zip(hue, light, m[:, 0], m[:, 1])])


def _row(ax: Axes, m: Array, places: Array, vacant: NDArray[np.bool_]) -> None:
    from matplotlib.ticker import MaxNLocator

    x = places[:, 0]
    step = max(1, int(np.ceil(len(m) / _ARROWS)))
    there = np.flatnonzero(~vacant[::step]) * step
    x, m = x[there], m[there]
    span = max(float(np.ptp(x)), 1.0)
    # arrows in the plane of the chain and z, what points out of it by its colour
    ax.quiver(x, 0 * x, m[:, 0], m[:, 2], color=colors(m), pivot="mid", units="width", scale=float(np.clip(0.6 * len(x), 14, 45)), width=0.0045, edgecolor="0.3", linewidth=0.3)
    ax.set_xlim(x.min() - 0.03 * span, x.max() + 0.03 * span)
    ax.set_ylim(-1, 1)
    ax.set_yticks([])
    ax.xaxis.set_major_locator(MaxNLocator(integer=True))
    ax.set_xlabel("site")
    ax.label_outer()


def _film(ax: Axes, m: Array, places: Array, vacant: NDArray[np.bool_]) -> None:
    from matplotlib.collections import PolyCollection

    top = places[:, 2] > places[:, 2].max() - 1e-6
    m, r, there = m[top], places[top][:, :2], ~vacant[top]
    ax.set_aspect("equal")
    distance = nearest(r)
    turn = np.arange(6) * np.pi / 3 + np.pi / 6
    corner = 0.58 * distance * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    rectangle = 0.5 * _cell(r, distance) * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    cell = rectangle if _is_square(r, distance) else corner
    ax.add_collection(PolyCollection(r[there][:, None, :] + cell[None], facecolors=colors(m[there]), edgecolors="face", linewidths=0.3))
    # where no spin is, as in spins.png: no direction is of that colour
    ax.set_facecolor("0.78")
    pad = cell.max(axis=0) + 0.1 * distance
    (left, bottom), (right, upper) = (r.min(axis=0) - pad).tolist(), (r.max(axis=0) + pad).tolist()
    ax.set_xlim(left, right)
    ax.set_ylim(bottom, upper)
    ax.set_xticks([])
    ax.set_yticks([])


def nearest(r: Array) -> float:
    """The distance of nearest neighbours, from some sites."""
    some = r[:: max(1, len(r) // 50)]
    d = np.linalg.norm(some[:, None] - r[None], axis=-1)
    d[d < 1e-9] = np.inf
    found = float(d.min()) if len(r) > 1 else 1.0
    return found if np.isfinite(found) else 1.0


def _cell(r: Array, distance: float) -> Array:
    """How far it is to the next site along x and along y."""
    way = np.abs(r - r[len(r) // 2])
    steps = [way[way[:, 1 - k] < 1e-6 * distance, k] for k in (0, 1)]
    return np.array([min(step[step > 1e-6 * distance], default=distance) for step in steps])


def _is_square(r: Array, distance: float) -> bool:
    """Whether neighbours stand along x and y alone."""
    middle = r[len(r) // 2]
    way = r - middle
    near = way[np.abs(np.linalg.norm(way, axis=1) - distance) < 1e-6]
    return bool(np.all(np.min(np.abs(near), axis=1) < 1e-6))


def lifetimes(ways: Mapping[str, tuple[Array, Array, NDArray[np.bool_]]], ax: Axes | None = None, **style: Any) -> Axes:
    """See :meth:`spinneb.Rates.plot`: by what a curve is called, temperatures (K), decimal logarithms of times (s), and where a
    barrier is low."""
    needs("matplotlib")
    import matplotlib.pyplot as plt

    ax = plt.subplots(figsize=(4.8, 3.2), layout="constrained")[1] if ax is None else ax
    drawn = {name: (1000 / t, *_drawn(log10_s, low)) for name, (t, log10_s, low) in ways.items()}
    partly = []
    for (name, (x, sure, low)), color in zip(drawn.items(), (CURVE, TOP)):
        if np.isfinite(sure).any():
            ax.plot(x, sure, **{"color": color, "marker": "o", "ms": 4, "label": name, **style})
            partly.append((x, low))
        elif np.isfinite(low).any():
            # what is low all along keeps its name, in a pale colour
            label = f"{name}, barrier below 5 $k_BT$"
            ax.plot(x, low, **{"color": color, "marker": "o", "ms": 4, "alpha": 0.45, "label": label, **style})
    grey = {**style, "color": "0.6", "marker": "o", "ms": 4, "zorder": 1}
    for k, (x, low) in enumerate(one for one in partly if np.isfinite(one[1]).any()):
        ax.plot(x, low, **{**grey, "label": "_" if k else "barrier below 5 $k_BT$"})
    ax.set_yscale("log")
    ax.set_xlabel("1000 K / T")
    ax.set_ylabel("mean lifetime (s)")
    if any(np.isfinite([sure, low]).any() for _, sure, low in drawn.values()):
        _levels(ax)
    else:
        for ticks in (ax.set_xticks, ax.set_yticks):
            ticks([])
            ticks([], minor=True)
        ax.annotate("no lifetime from 10⁻¹⁵ s to 10²⁵ s", (0.5, 0.5), xycoords="axes fraction", ha="center")
    labels = len(ax.get_legend_handles_labels()[1])
    if labels > 1 or (labels and not partly):
        ax.legend(fontsize="small", frameon=False)
    return ax


def _drawn(log10_s: Array, low: NDArray[np.bool_]) -> tuple[Array, Array]:
    """Times (s) that are sure and those where a barrier is low, with gaps in place of the others."""
    within = (log10_s >= np.log10(SHORTEST_S)) & (log10_s <= np.log10(LONGEST_S))
    s = 10 ** np.where(within, log10_s, np.nan)
    # the grey line reaches to the first point of the other
    reach = low.copy()
    reach[1:] |= low[:-1]
    reach[:-1] |= low[1:]
    return np.where(low, np.nan, s), np.where(reach & low.any(), s, np.nan)


def _levels(ax: Axes) -> None:
    """Lines at a second and at ten years, where they are within the figure; named on the hot side, where curves are low."""
    bottom, top = ax.get_ylim()
    for seconds, words in [(1.0, "1 s"), (10 * 365.25 * 86400, "10 years")]:
        if bottom < seconds < top:
            ax.axhline(seconds, color="0.7", lw=0.8, ls="--", zorder=0)
            # above the line, unless the frame would cross the words
            under = np.log(seconds / bottom) > 0.9 * np.log(top / bottom)
            ax.annotate(words, (0.01, seconds), xycoords=("axes fraction", "data"), ha="left", va="top" if under else "bottom",
                        fontsize="small", color="0.4")
