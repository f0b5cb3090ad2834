"""Results for those who come from ASE."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

from .api import load
from .results import Result

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["NEBTools"]

#: meV of an eV
_EV = 1e3


class NEBTools:
    """A band as ``ase.mep.NEBTools`` tells of it, energies in eV as there.

    Parameters
    ----------
    result
        A result, or the folder of one.
    """

    def __init__(self, result: Result | str | os.PathLike[str]) -> None:
        found = result if isinstance(result, Result) else load(result)
        if not isinstance(found, Result):
            raise TypeError("a landscape is no band")
        self.result = found

    def get_barrier(self, fit: bool = True, raw: bool = False) -> tuple[float, float]:
        """The barrier and the energy of the final state above the initial one (eV).

        Parameters
        ----------
        fit
            The barrier of the refined saddle, which needs no fit here; else that of the highest image.
        raw
            The energy of the top itself in place of the barrier.
        """
        e = self.result.above_initial_meV
        barrier = self.result.barrier_meV
        if fit and barrier is None:
            raise ValueError(f"there is no barrier: {self.result.stop_reason}")
        top = barrier["forward"] if fit and barrier is not None else float(e.max())
        top += float(self.result.energies_meV[0]) if raw else 0.0
        return top / _EV, float(e[-1]) / _EV

    def plot_band(self, ax: Axes | None = None, **style: Any) -> Figure:
        """The energy path on axes; its figure."""
        figure = self.result.plot(ax, **style).figure
        return figure  # type: ignore[return-value]
