"""The cases both programs solve, energies in meV: open chains with J = 10 meV a bond and K = 0.5 meV a site, and the collapse of a
skyrmion in a periodic film with J = 10 and D = 6 meV a bond, 2 μ_B a site and 25 T.

exact.py computes the exact barriers of the chains. Those of the films are of saddles to rounding: at 30² sites NumPy finds the same,
at 64² and 128² they are equal to 15 digits.
"""

import math

J = 10.0
D, MOMENT, FIELD = 6.0, 2.0, 25.0  # of the films: meV, μ_B, T
BOHR_MAGNETON = 5.7883817982e-2  # meV/T
WIDTH = math.sqrt(J / (2 * 0.5))  # of a wall, in sites


def strengths(sites, changed):
    """K of each site."""
    return [changed.get(i, 0.5) for i in range(sites)]


def film(cells, exact, goal):
    """The collapse in a film of so many cells a side; here spinneb too is run with numbers of images to suit."""
    own = [] if cells == 30 else ["--set", f"lattice.square.cells=[{cells},{cells}]"]
    return dict(config="benches/peers/collapse.json", set=own, given="ends", cells=cells, relax_ends=True, exact_meV=exact, goal=goal, suits=True)


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
    "collapse, 30²": film(30, 38.834088448620, goal=10),
    "collapse, 64²": film(64, 38.834382753402, goal=15),
    "collapse, 128²": film(128, 38.834382753405, goal=20),
}
