"""The exact barriers of the cases, by Newton iterations on the angles of the spins: `python exact.py`.

A planar state has m = (sin θ, 0, cos θ), E = Σ J [1 − cos(θ_i − θ_{i+1})] + Σ K_i sin² θ_i, so its stationary points are the
roots of N equations with a tridiagonal Jacobian. All walls here are planar. Started from a wall placed by symmetry on the
saddle, or on the pinning site for the minimum, Newton's method reaches the root to rounding in a few steps.
"""

import numpy as np

from cases import CASES, J, WIDTH


def wall(sites, centre):
    """θ of the continuum's wall, 0 on the left and π on the right."""
    return np.arccos(-np.tanh((np.arange(sites) - centre) / WIDTH))


def energy(t, k):
    return J * (2 * np.sin((t[1:] - t[:-1]) / 2) ** 2).sum() + (k * np.sin(t) ** 2).sum()


def stationary(t, k):
    """The stationary point near t, by Newton's method; the last torque (meV) must be rounding."""
    n = len(t)
    for _ in range(30):
        sin, cos = J * np.sin(t[1:] - t[:-1]), J * np.cos(t[1:] - t[:-1])
        g = k * np.sin(2 * t)
        g[:-1] -= sin
        g[1:] += sin
        if abs(g).max() < 1e-14:
            break
        h = np.diag(2 * k * np.cos(2 * t)) - np.diag(cos, 1) - np.diag(cos, -1)
        h[range(n - 1), range(n - 1)] += cos
        h[range(1, n), range(1, n)] += cos
        t = t - np.linalg.solve(h, g)
    assert abs(g).max() < 1e-12, abs(g).max()
    return t


def barrier_mev(case):
    """The wall midway, by symmetry the saddle, above the initial state."""
    k = np.array(case["K"])
    sites = len(k)
    if case["ends"] == "uniform":
        return energy(stationary(wall(sites, (sites - 1) / 2), k), k)
    start = wall(sites, 45)
    if case["relax_ends"]:
        start = stationary(start, k)
    return energy(stationary(wall(sites, 50), k), k) - energy(start, k)


if __name__ == "__main__":
    for name, case in ((name, case) for name, case in CASES.items() if "K" in case):
        print(f"{name}: {barrier_mev(case):.15f} meV; in cases.py {case['exact_meV']:.15f}")
