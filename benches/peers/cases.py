"""The cases both programs solve: open chains with J = 10 meV a bond and K = 0.5 meV a site, energies in meV.

exact.py computes the exact barriers.
"""

import math

J = 10.0
WIDTH = math.sqrt(J / (2 * 0.5))  # of a wall, in sites


def strengths(sites, changed):
    """K of each site."""
    return [changed.get(i, 0.5) for i in range(sites)]


CASES = {
    "nucleation": {
        "config": "configs/wall_nucleation.json",
        "given": "ends",  # what the config gives spinneb to start from
        "K": strengths(50, {}),
        "ends": "uniform",
        "relax_ends": False,  # all up and all down are minima as they are
        "exact_meV": 6.29777750720048838,
        "goal": 30,
    },
    "depinning, K doubled": {
        "config": "benches/peers/depinning_doubled.json",
        "given": "ends",
        "K": strengths(100, {50: 1.0}),
        "ends": "wall",
        "relax_ends": False,  # relaxed, the walls would slide off
        "exact_meV": 0.421395089429799,
        "goal": 10,
    },
    "depinning, K halved": {
        "config": "configs/wall_depinning.json",
        "given": "ends, geodesic",
        "K": strengths(100, {45: 0.25, 55: 0.25}),
        "ends": "wall",
        "relax_ends": True,
        "exact_meV": 0.170008526447337,
        "goal": 10,
    },
}
