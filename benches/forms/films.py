"""Random films, and the forms that one and the same film can be written in."""

import numpy as np

MU_B = 5.7883817982e-2  # meV/T
UP = np.array([0.0, 0.0, 1.0])
ORDERED = ["reversal", "field", "dmi", "tilted", "pinned", "collapse"]
DISORDERED = ["strengths", "bonds", "both", "dmi and strengths"]


class Film:
    """Spins of 1 μ_B on a square lattice: every bond, easy axis and field by itself. Energies in meV."""

    def __init__(self, cells, k):
        self.cells, self.periodic = cells, False
        n = cells[0] * cells[1]
        self.at = np.array([[i % cells[0], i // cells[0]] for i in range(n)], float)
        self.k = np.full(n, k)
        self.hard = 0.0  # along x
        self.field = np.zeros(3)
        self.ends = [np.tile(UP, (n, 1)), np.tile(-UP, (n, 1))]
        self.d = 0.0

    def bonds(self, random=None):
        """Site, site, cell of the second, J, D of every bond; J is 1, or anything from 0.6 to 1.4."""
        (nx, ny), found = self.cells, []
        for i in range(nx * ny):
            for step in ([1, 0], [0, 1]):
                x, y = i % nx + step[0], i // nx + step[1]
                if self.periodic or (x < nx and y < ny):
                    j = 1 + (random.uniform(-0.4, 0.4) if random is not None else 0)
                    d = self.d * np.array([-step[1], step[0], 0.0])
                    found.append((i, x % nx + nx * (y % ny), [x // nx, y // ny, 0], j, d))
        self.bond_list = found
        return self


def ordered(number):
    """One of six kinds by turns."""
    kind = ORDERED[number % len(ORDERED)]
    r = np.random.default_rng(number)
    film = Film((int(r.integers(4, 9)), int(r.integers(3, 8))), r.uniform(0.15, 0.5))
    k = film.k[0]
    if kind == "field":
        film.field = np.array([0, 0, -r.uniform(0.2, 0.9) * k])
    if kind == "dmi":
        film.d = r.uniform(0.05, 0.3)
    if kind == "tilted":
        film.hard, film.field = 0.3 * k, r.uniform(-0.3, 0.3, 3) * k
    if kind == "pinned":
        film = Film((int(r.integers(8, 13)), int(r.integers(2, 5))), r.uniform(0.3, 0.6))
        film.hard = 0.4 * film.k[0]
        columns = film.at[:, 0]
        places = [2, film.cells[0] - 3]
        film.k[np.isin(columns, places)] *= 0.4
        for end, place in zip(film.ends, places):
            theta = 2 * np.arctan(np.exp((columns - place) / 1.1))
            end[:] = np.stack([0 * theta, np.sin(theta), np.cos(theta)], axis=1)
    if kind == "collapse":
        size = int(r.integers(7, 11))
        film = Film((size, size), 0.08)
        film.periodic, film.d, film.field = True, 1.0, np.array([0, 0, r.uniform(0.38, 0.5)])
        away = film.at - (size - 1) // 2
        theta = np.pi * np.clip(1 - np.hypot(*away.T) / 3.6, 0, None)
        phi = np.arctan2(away[:, 1], away[:, 0]) + np.pi
        film.ends = [np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=1), film.ends[0]]
    return kind, film.bonds()


def disordered(number):
    """Reversal of films of up to 300 sites whose strengths, bonds or both differ from place to place."""
    kind = DISORDERED[number % len(DISORDERED)]
    r = np.random.default_rng(1000 + number)
    small = number % 8 < 4
    cells = (int(r.integers(4, 11)), int(r.integers(3, 11))) if small else (int(r.integers(6, 18)), int(r.integers(6, 18)))
    film = Film(cells, r.uniform(0.1, 0.5))
    k = film.k[0]
    film.hard, film.field = 0.1 * k, np.array([0, 0, -r.uniform(0, 0.2) * k])
    film.d = r.uniform(0.05, 0.3) if "dmi" in kind else 0.0
    if kind != "bonds":
        film.k = film.k * (1 + r.uniform(-0.6, 0.6, len(film.k)))
    return kind, film.bonds(r if kind in ("bonds", "both") else None)


def rotation(axis, angle):
    a = np.asarray(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def forms(film, number):
    """The same film in other words, by name: what `config` is given."""
    r = np.random.default_rng(10_000 + number)
    nx, ny = film.cells
    turned = rotation([0.3, -0.5, 0.8], 1.1)
    return {
        "as it is": {},
        "numbered by columns": {"new": np.array([i % nx * ny + i // nx for i in range(nx * ny)])},
        "numbered at random": {"new": r.permutation(nx * ny)},
        "lattice turned": {"lattice": rotation(UP, 0.4)},
        "spins turned": {"spins": turned},
        "spins mirrored": {"spins": turned @ np.diag([1.0, -1.0, 1.0])},
        "time reversed": {"spins": -np.eye(3)},
        "ends exchanged": {"exchanged": True},
    }


def config(film, new=None, lattice=np.eye(3), spins=np.eye(3), exchanged=False):
    """As a config: site i gets the number new[i], places are turned by one matrix, spins by another."""
    n = len(film.k)
    new = np.arange(n) if new is None else new
    old = np.argsort(new)
    numbers = lambda v: [float(x) for x in v]
    mev = lambda x: f"{float(x)!r} meV"
    # vector products keep another sign where spins are mirrored
    axial = round(np.linalg.det(spins)) * spins
    bonds = [
        {"from": int(new[i]), "to": int(new[j]), "cell": cell, "J": mev(exchange), "D": [mev(x) for x in axial @ d]}
        for i, j, cell, exchange, d in film.bond_list
    ]
    basis = [{"at": numbers([*(film.at[i] / film.cells), 0])} for i in old]
    vectors = [numbers(lattice @ v) for v in ([film.cells[0], 0, 0], [0, film.cells[1], 0], [0, 0, 1])]
    ends = film.ends[::-1] if exchanged else film.ends
    state = lambda m: {"vectors": [numbers(spins @ m[i]) for i in old]}
    return {
        "material": {
            "name": "random",
            "moment": "1 mu_B",
            "energy": [
                {"pairs": {"bonds": bonds}},
                {"anisotropy": {"K": [mev(film.k[i]) for i in old], "axis": numbers(spins @ UP)}},
                {"anisotropy": {"K": mev(-film.hard), "axis": numbers(spins @ [1.0, 0.0, 0.0])}},
                {"zeeman": {"B": [f"{float(x) / MU_B!r} T" for x in spins @ film.field]}},
            ],
        },
        "lattice": {
            "crystal": {"vectors": vectors, "basis": basis, "cells": [1, 1, 1], "periodic": [film.periodic, film.periodic, False]}
        },
        "initial": state(ends[0]),
        "final": state(ends[1]),
        "output": {"formats": [], "plots": []},
    }
