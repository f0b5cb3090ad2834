"""Energy terms of your own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Literal, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import terms

__all__ = ["Term"]

#: of vectors (site, xyz): anything that numpy takes for an array
Function = Callable[[NDArray[np.float64]], ArrayLike]


class Term:
    """An energy term of functions of yours, beside the built-in ones: ``energy=[sn.exchange(J="10 meV"), sn.Term(f, g)]``.

    When a run begins it is checked on random states by differences: an energy or gradient that is not finite, a gradient that is
    not that of the energy (to a part in a million), or a wrong ``reach`` or ``quadratic`` is a :class:`~spinneb.ConfigError`, and
    so a ``ValueError``. Whatever the functions raise, a run raises too.

    Parameters
    ----------
    energy
        f(m) → the energies of the sites, shape (N,), or one number, in meV; m has the shape (N, 3) and unit rows, and is read-only.
    gradient
        g(m) → ∂E/∂m, shape (N, 3), in meV. Its part along the spins does not matter.
    name
        What its energy is called in results; letters, digits, ``.``, ``_`` and ``-``. If left out, the name of the function, or
        ``"term"`` where that is taken (``energy``, ``exchange``, …).
    reach
        How far apart sites are that act on each other: a number of lattice constants (in a chain, sites), ``"dense"`` if all
        sites do (600 at most), or ``None`` to find out.
    quadratic
        Whether the energy is a polynomial of second degree in the components of the spins, whose second derivatives are the same
        everywhere; ``None`` to find out. Runs are quicker with one that is.
    hessian
        h(m, v) → (∂²E/∂m∂m) v, shape (N, 3), in meV, for tangent vectors v of the shape (N, 3). Without it differences of the
        gradient do: of sixth order, evaluated for many sites at once.

    The functions are called from other threads, one at a time. A config that names such a term can be run from Python only.
    """

    def __init__(
        self,
        energy: Function,
        gradient: Function,
        *,
        name: str | None = None,
        reach: float | Literal["dense"] | None = None,
        quadratic: bool | None = None,
        hessian: Callable[[NDArray[np.float64], NDArray[np.float64]], ArrayLike] | None = None,
    ) -> None:
        if not callable(energy) or not callable(gradient):
            raise TypeError("a Term takes two functions: energy(m) and gradient(m)")
        own = getattr(energy, "__name__", "")
        # a column of the tables may have its name already
        free = own.isidentifier() and own not in ("energy", *terms.__all__)
        self.name: str = name if name is not None else own if free else "term"
        self.energy = energy
        self.gradient = gradient
        self.reach = reach
        self.quadratic = quadratic
        self.hessian = hessian

    def _parts(self) -> tuple[Any, ...]:
        return self.name, self.energy, self.gradient, self.reach, self.quadratic, self.hessian

    def __eq__(self, other: object) -> bool:
        return self._parts() == other._parts() if isinstance(other, Term) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._parts())

    def __repr__(self) -> str:
        return f"Term({self.name!r})"

    # what the library calls: views in, bytes out

    def _energy(self, view: object) -> bytes:
        m = np.asarray(view)
        with np.errstate(all="ignore"):
            e = self._asked(self.energy(m), "energy")
        if e.ndim == 0:
            e = np.full(len(m), float(e) / len(m))
        return self._checked(e, (len(m),), "energy").tobytes()

    def _gradient(self, view: object) -> bytes:
        m = np.asarray(view)
        with np.errstate(all="ignore"):
            g = self._asked(self.gradient(m), "gradient")
        return self._checked(g, m.shape, "gradient").T.tobytes()

    def _hessian(self, views: Sequence[object]) -> bytes:
        m, v = (np.asarray(view) for view in views)
        assert self.hessian is not None
        with np.errstate(all="ignore"):
            h = self._asked(self.hessian(m, v), "hessian")
        return self._checked(h, m.shape, "hessian").T.tobytes()

    def _asked(self, found: Any, what: str) -> NDArray[Any]:
        if found is None:
            raise ValueError(f"the {what} of the term {self.name!r} returned nothing: does the function end with return?")
        numbers = np.asarray(found)
        if numbers.dtype.kind == "c" or (numbers.dtype.kind == "f" and numbers.dtype.itemsize < 8):
            raise ValueError(f"the {what} of the term {self.name!r} is of {numbers.dtype}, but energies need float64 (jax: jax_enable_x64)")
        return numbers.astype(np.float64, copy=False)

    def _checked(self, found: NDArray[Any], shape: tuple[int, ...], what: str) -> NDArray[Any]:
        if found.shape != shape:
            raise ValueError(f"the {what} of the term {self.name!r} has the shape {found.shape}, expected {shape}")
        return found


#: what a System takes in its list of terms
AnyTerm = Union[Term, dict[str, Any]]
