"""HTST and Langer of a skyrmion of Pd/Fe/Ir(111), exchange over nine shells, by dense matrices alone.

    python nine_shells.py path.npz > nine_shells.json

The states are brought to rest by Newton's method from those given, with an energy, gradient and Hessian written out here from the
constants below. See tests/reference/README.md.
"""
import json
import sys

import numpy as np

MU_B, K_B, HBAR = 5.7883817982e-2, 8.617333262e-2, 6.582119569e-13  # meV/T, meV/K, meV s
N, MOMENT, FIELD = 20, 3.0, 4.0
J = [28.8, -4.96, -5.38, 1.04, 1.48, 0.56, 0.32, -1.14, -0.42]
D, K = 2.0, 0.7
DAMPING = 0.3

A = np.array([[1.0, 0.0], [0.5, np.sqrt(0.75)]])
SITES = N * N


def shells():
    cells = [(a, b) for a in range(-6, 7) for b in range(-6, 7) if (a, b) != (0, 0)]
    square = {c: c[0] ** 2 + c[0] * c[1] + c[1] ** 2 for c in cells}
    lengths = sorted(set(square.values()))[: len(J)]
    return [[c for c in cells if square[c] == l] for l in lengths]


def site(a, b):
    return (a % N) + N * (b % N)


def quadratic():
    """E = ½ mᵀ A m + bᵀ m over all 3N components, site by site."""
    a, b = np.zeros((SITES, 3, SITES, 3)), np.zeros((SITES, 3))
    b[:, 2] = -MOMENT * MU_B * FIELD
    for x in range(N):
        for y in range(N):
            i = site(x, y)
            a[i, 2, i, 2] -= 2 * K
            for n, shell in enumerate(shells()):
                for c in shell:  # each bond is met from both of its ends
                    j = site(x + c[0], y + c[1])
                    a[i, :, j, :] -= J[n] * np.eye(3)
                    if n == 0:
                        r = c @ A
                        d = D * np.array([-r[1], r[0], 0.0])  # ẑ × r
                        a[i, :, j, :] += np.array([[0, d[2], -d[1]], [-d[2], 0, d[0]], [d[1], -d[0], 0]])
    return a.reshape(3 * SITES, 3 * SITES), b.reshape(-1)


class State:
    def __init__(self, a, b, m):
        for _ in range(6):
            self.at(a, b, m)
            values, vectors = np.linalg.eigh(self.hessian)
            stiff = np.abs(values) > 1e-6
            step = -(vectors[:, stiff] / values[stiff]) @ (vectors[:, stiff].T @ self.gradient)
            turned = m + (self.basis @ step).reshape(SITES, 3)
            m = turned / np.linalg.norm(turned, axis=1)[:, None]
        self.at(a, b, m)
        assert np.abs(self.gradient).max() < 1e-11, np.abs(self.gradient).max()
        self.values, self.vectors = np.linalg.eigh(self.hessian)

    def at(self, a, b, m):
        self.m = m
        self.energy = 0.5 * m.ravel() @ a @ m.ravel() + b @ m.ravel()
        force = (a @ m.ravel() + b).reshape(SITES, 3)
        self.basis = np.zeros((3 * SITES, 2 * SITES))
        for i, s in enumerate(m):
            u = np.cross(s, np.eye(3)[np.argmin(np.abs(s))])
            u /= np.linalg.norm(u)
            self.basis[3 * i : 3 * i + 3, 2 * i] = u
            self.basis[3 * i : 3 * i + 3, 2 * i + 1] = np.cross(s, u)
        bent = np.repeat((m * force).sum(1), 2)
        self.hessian = self.basis.T @ a @ self.basis - np.diag(bent)
        self.gradient = self.basis.T @ force.ravel()

    def turn(self):
        """v → m × v in the tangent basis."""
        r = np.zeros((2 * SITES, 2 * SITES))
        for i in range(SITES):
            r[2 * i + 1, 2 * i], r[2 * i, 2 * i + 1] = 1.0, -1.0
        return r

    def derivatives(self, against):
        grid = self.m.reshape(N, N, 3)  # second direction first
        found = []
        for axis in (1, 0):
            sum_ = sum(w * (np.roll(grid, -k, axis) - np.roll(grid, k, axis)) for k, w in ((1, 45), (2, -9), (3, 1)))
            v = self.basis.T @ (sum_ / 60).ravel()
            for t in against:
                v = v - t * (t @ v)
            found.append(v)
        return np.array(found).T

    def slid(self, against):
        """The valleys along translations: K, U by way, √det G and ln det of the space normal to them."""
        v = self.derivatives(against)
        z, _ = np.linalg.qr(v)
        y = np.linalg.solve(self.hessian, z)
        for t in against:
            y = y - np.outer(t, t @ y)
        w, _ = np.linalg.qr(y)
        stiffness = np.linalg.inv(w.T @ np.linalg.solve(self.hessian, w))
        part = w.T @ v
        curvature = part.T @ stiffness @ part
        own = np.diag(curvature)
        scale = np.sqrt(np.linalg.det(curvature) / own.prod())
        normal = np.linalg.svd(w.T)[2][2:].T
        sign, ln = np.linalg.slogdet(normal.T @ self.hessian @ normal)
        return {
            "pinning_meV": list(scale * own / (2 * np.pi**2)),
            "volume_rad": SITES * np.sqrt(np.linalg.det(part.T @ part)),
            "ln_determinant": ln,
        }


def main(path):
    spins = np.load(path)["spins"]
    a, b = quadratic()
    low, up = State(a, b, spins[0]), State(a, b, spins[-1])
    energies = [0.5 * m.ravel() @ a @ m.ravel() + b @ m.ravel() for m in spins]
    top = State(a, b, spins[np.argmax(energies)])
    mode = top.vectors[:, 0]
    gyration = 2.0 / (MOMENT * HBAR)
    w = gyration * (top.turn() @ mode)
    htst = np.sqrt(-top.values[0] * (w @ top.hessian @ w))
    flow = -gyration / (1 + DAMPING**2) * (DAMPING * np.eye(2 * SITES) + top.turn()) @ top.hessian
    langer = np.linalg.eigvals(flow).real.max()
    print(json.dumps({
        "barrier_meV": [top.energy - low.energy, top.energy - up.energy],
        "descending_meV": top.values[0],
        "htst_per_s": htst,
        "langer_per_s": langer,
        "skyrmion": low.slid([]),
        "saddle": top.slid([mode]),
        "ferromagnet_ln_determinant": np.log(up.values).sum(),
        "negative": [int((s.values < -1e-9).sum()) for s in (low, top, up)],
    }, indent=1))


main(*sys.argv[1:])
