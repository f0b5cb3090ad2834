"""Methods that move a path to its minimum.

Written by generate.py from the schema of a config; change that, not this.
"""

from __future__ import annotations

from ._values import Optimiser, as_count

__all__ = [
    "implicit",
    "preconditioned",
    "velocity_projection",
    "lbfgs",
]


def implicit() -> Optimiser:
    """The implicit uphill sweep on true banded Hessians: about ten evaluations at any length (default).

    In a config: ``{"implicit": {}}``
    """
    return Optimiser("implicit", {})


def preconditioned() -> Optimiser:
    """ODE12r on forces preconditioned by the exchange operator: for terms without a banded Hessian.

    In a config: ``{"preconditioned": {}}``
    """
    return Optimiser("preconditioned", {})


def velocity_projection() -> Optimiser:
    """Damped masses along the spring forces: the field's usual method, to compare with.

    In a config: ``{"velocity_projection": {}}``
    """
    return Optimiser("velocity_projection", {})


def lbfgs(
    *,
    memory: int | None = None,
) -> Optimiser:
    """Limited-memory BFGS along the spring forces, to compare with.

    Parameters
    ----------
    memory
        Pairs of differences to keep. Default: 5.

    In a config: ``{"lbfgs": {"memory": 5}}``
    """
    return Optimiser("lbfgs", {"memory": as_count(memory, "memory", 0)})
