"""Spins in three dimensions (pyvista)."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._optional import needs
from .plotting import Array, colors, nearest


def arrows(
    states: Sequence[Array], places: Array, vacant: NDArray[np.bool_], titles: Sequence[str], plotter: Any = None, **style: Any
) -> Any:
    """States side by side as arrows at their sites, where there is a spin; all in the view of a plotter that is given."""
    # whose types are not needed, and take a checker minutes to read
    needs("pyvista")
    pyvista = import_module("pyvista")
    n = len(states)
    own = pyvista.Plotter(shape=(1, n), window_size=(min(480 * n, 1920), 440)) if plotter is None else plotter
    length = 0.85 * nearest(places)
    arrow = pyvista.Arrow(start=(-0.5, 0, 0), tip_length=0.4, tip_radius=0.2, shaft_radius=0.08, tip_resolution=12, shaft_resolution=8)
    for k, (m, title) in enumerate(zip(states, titles)):
        if plotter is None:
            own.subplot(0, k)
            own.set_background("white")
            own.add_text(title, font_size=9, color="black")
        sites = pyvista.PolyData(np.array(places[~vacant]))
        sites["spins"] = np.array(m[~vacant])
        sites["colors"] = np.rint(255 * colors(m[~vacant])).astype(np.uint8)
        glyphs = sites.glyph(orient="spins", scale=False, factor=length, geom=arrow)
        own.add_mesh(glyphs, **{"scalars": "colors", "rgb": True, "ambient": 0.25, **style})
    if plotter is None:
        own.link_views()
        own.view_isometric()
        own.camera.zoom(1.4)
    return own
