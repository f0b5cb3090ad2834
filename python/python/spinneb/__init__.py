"""Minimum-energy paths, barriers, certified saddles and lifetimes of spins on a lattice.

>>> import spinneb as sn
>>> system = sn.System(sn.chain(20), [sn.exchange(J=["10 meV"]), sn.anisotropy(K="0.5 meV")])
>>> result = sn.barrier(system, sn.uniform("z"), sn.uniform("-z"))
>>> round(result.barrier_meV["forward"], 6)
6.252171
>>> result.certified
True

Energies are in meV, angles and lengths of paths in rad; quantities are strings with their unit. The lattices, terms, states, guesses
and shapes are those of the command line, ``spinneb list``.
"""

from . import guesses, lattices, optimisers, shapes, states, terms
from ._core import version as __version__
from ._errors import ConfigError, SpinnebError
from ._values import Energy, Guess, Lattice, Optimiser, Shape, State
from .api import barrier, check, landscape, load, rates, relax, run
from .bands import NEBTools
from .fields import from_field, to_field
from .guesses import drift, droplet, geodesic, nlerp, rotation, shrink, sweep, translation, waypoints
from .lattices import *
from .results import Check, Landscape, Rates, Relaxed, Result, Saddle
from .states import *
from .system import System
from .term import Term
from .terms import *

__all__ = [
    "Check",
    "ConfigError",
    "Energy",
    "Guess",
    "Landscape",
    "Lattice",
    "NEBTools",
    "Optimiser",
    "Rates",
    "Relaxed",
    "Result",
    "Saddle",
    "Shape",
    "SpinnebError",
    "State",
    "System",
    "Term",
    "__version__",
    "barrier",
    "check",
    "from_field",
    "guesses",
    "landscape",
    "lattices",
    "load",
    "optimisers",
    "rates",
    "relax",
    "run",
    "shapes",
    "states",
    "terms",
    "to_field",
]
__all__ += lattices.__all__
__all__ += terms.__all__
__all__ += states.__all__
# but for `guesses.file`: the `file` of here is the state
__all__ += ["drift", "droplet", "geodesic", "nlerp", "rotation", "shrink", "sweep", "translation", "waypoints"]
