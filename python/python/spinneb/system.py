"""Spins on a lattice with an energy: what a config says, without files."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from . import _core
from ._html import paragraph, table
from ._keys import check_keys, hint
from ._read import read
from ._values import AnyState, Array, Lattice, Values, as_json, as_state, in_nm, plain
from .states import uniform
from .term import AnyTerm, Term

__all__ = ["System"]


class System:
    """Spins on a lattice with an energy; with two states it is all that a run needs.

    Parameters
    ----------
    lattice
        Where the spins are: ``sn.chain(50)``, ``sn.triangular(40, 40, periodic=True)``, …
    energy
        The terms: ``sn.exchange(J=["10 meV"])``, …, and :class:`~spinneb.Term` for those of your own.
    material
        A material of the library (``"permalloy"``; ``spinneb list materials``), a file, or a dictionary; ``energy`` is added to
        its terms.
    moment
        Moment of a site: ``"3 mu_B"``. Fields and rates need it (or ``Ms``).
    Ms
        Saturation magnetisation of a continuum: ``"800 kA/m"``.
    name
        What results are called.
    initial, final
        The two states of a path, or later, in :func:`~spinneb.barrier`.
    options
        Any other key of a config (``rates={"temperatures": ["300 K"]}``, ``neb={…}``).
    """

    def __init__(
        self,
        lattice: Lattice | Mapping[str, Any],
        energy: Iterable[AnyTerm] = (),
        *,
        material: str | Mapping[str, Any] | None = None,
        moment: Values | None = None,
        Ms: Values | None = None,
        name: str | None = None,
        initial: AnyState | None = None,
        final: AnyState | None = None,
        **options: Any,
    ) -> None:
        if material is not None and (moment is not None or Ms is not None):
            raise TypeError("a material has its own moment: give either material= or moment= (Ms=)")
        if isinstance(energy, (Term, Mapping)):
            raise TypeError(f"energy is a list of terms, also of one: write [{energy!r}]")
        terms = list(energy)
        for term in terms:
            if not isinstance(term, (Term, Mapping)):
                raise TypeError(f"an energy term is made by exchange(…), anisotropy(…) … or Term(…), found {term!r}")
        self.lattice = lattice
        #: all terms, those of your own among them
        self.energy = terms
        _named(self.terms)
        check_keys(options, _ARGUMENTS)
        self.material = material
        self.moment = moment
        self.Ms = Ms
        self.name = name
        self.initial = initial
        self.final = final
        self.options = options

    def __setattr__(self, name: str, value: Any) -> None:
        # a word that is none would be kept, and never be read
        if name not in _ATTRIBUTES:
            raise AttributeError(f"a System has no {name!r}" + hint(name, _ATTRIBUTES))
        super().__setattr__(name, value)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, System):
            return NotImplemented
        return bool(plain(vars(self)) == plain(vars(other)))

    @property
    def terms(self) -> list[Term]:
        """The terms of your own."""
        return [term for term in self.energy if isinstance(term, Term)]

    @property
    def places(self) -> Array:
        """Where the sites are, (N, 3), in lattice constants; in a chain x is the number of the site."""
        return np.asarray(self._core().places)

    @property
    def places_nm(self) -> Array | None:
        """The same in nm; ``None`` where the lattice was given no length."""
        core = self._core()
        return in_nm(np.asarray(core.places), core.spacing_nm)

    def _core(self) -> _core.Config:
        """It, read; states have no part in it."""
        return read(self.config(initial=uniform("z"), final=uniform("z")), self.terms, "relax", [])

    def config(self, initial: AnyState | None = None, final: AnyState | None = None, **options: Any) -> dict[str, Any]:
        """The system as a config, with these states and keys in place of its own."""
        material: Any = self.material
        if material is None:
            material = {"name": self.name or "system", "moment": self.moment, "Ms": self.Ms}
            material = {key: value for key, value in material.items() if value is not None}
        config = {
            "name": self.name,
            "material": material,
            "lattice": self.lattice,
            "energy": [term for term in self.energy if not isinstance(term, Term)],
            "custom_terms": [term.name for term in self.terms] or None,
            "initial": as_state(self.initial if initial is None else initial, "initial"),
            "final": as_state(self.final if final is None else final, "final"),
            **self.options,
            **options,
        }
        kept: dict[str, Any] = plain({key: value for key, value in config.items() if value is not None})
        return kept

    def to_json(self, initial: AnyState | None = None, final: AnyState | None = None, **options: Any) -> str:
        """The config as text, for a file that ``spinneb run`` takes too, unless the system has terms of your own."""
        config = self.config(initial, final, **options)
        guess = config.get("path", {}).get("guess")
        if isinstance(guess, list):
            states = [{"vectors": image} for image in guess[1:-1]]
            config["path"] = {**config["path"], "guess": {"waypoints": {"states": states}}}
        return as_json(config, indent=2)

    def replaced(self, **changes: Any) -> System:
        """The same system with other arguments: ``system.replaced(moment="2 mu_B")``."""
        own = {name: getattr(self, name) for name in _ARGUMENTS} | self.options
        return System(**{**own, **changes})

    def _repr_html_(self) -> str:
        rows: list[tuple[str, Any]] = [("lattice", self.lattice), ("material", self.material), ("moment", self.moment), ("Ms", self.Ms)]
        rows += [("energy" if k == 0 else "", term) for k, term in enumerate(self.energy)]
        rows += [("initial", _shown(self.initial)), ("final", _shown(self.final)), *self.options.items()]
        shown = [(key, value if isinstance(value, str) else repr(value)) for key, value in rows if value is not None]
        return paragraph(f"System {self.name or ''}") + table(shown)

    def __repr__(self) -> str:
        shown = [f"lattice={self.lattice!r}"]
        shown += [
            f"{key}={value!r}"
            for key, value in [("material", self.material), ("moment", self.moment), ("Ms", self.Ms), ("name", self.name)]
            if value is not None
        ]
        return f"System({', '.join(shown)}, energy={self.energy!r})"


#: what a System takes beside other keys of a config, and what it keeps
_ARGUMENTS = ("lattice", "energy", "material", "moment", "Ms", "name", "initial", "final")
_ATTRIBUTES = (*_ARGUMENTS, "options")


def _shown(state: AnyState | None) -> Any:
    """A state in words; of vectors how many they are."""
    return state if state is None or isinstance(state, Mapping) else f"vectors of shape {np.shape(state)}"


def _named(terms: list[Term]) -> None:
    """An error where two have one name."""
    names = [term.name for term in terms]
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f"two terms are called {name!r}: give each a name of its own, Term(…, name=…)")
