"""One case with spirit, in a process of its own: `scout` looks for its best settings, `solve` runs one setting against the clock.

The request is JSON in the first argument, the answer one line of JSON on stdout. CPU seconds are those of this process while
spirit computes: building the Hamiltonian and the first path, and reading energies to see how far it is, are not counted.
"""

import contextlib
import itertools
import json
import os
import sys
import tempfile
import time

import numpy as np
from spirit import chain, parameters, simulation, state, system, transition

from cases import BOHR_MAGNETON, CASES, D, FIELD, J, MOMENT, WIDTH

SOLVERS = ["LBFGS_OSO", "LBFGS_Atlas", "VP", "VP_OSO"]
PLAIN_MEV = [None, 1e-2, 1e-4]  # the force below which images begin to climb; None: at once
CLIMBING = ["the highest", "all maxima"]
TIGHTEST_MEV = 1e-7  # spirit's force tolerance at the end of a scouting run
RIGHT = 1e-6  # relative error of a barrier that counts as right
QUIET = ["log_to_file 0", "log_to_console 0", "save_input_initial 0", "save_input_final 0", "save_positions_initial 0"]
QUIET += ["save_neighbours_initial 0", "ddi_method none", "gneb_output_any 0", "llg_output_any 0", "gneb_n_energy_interpolations 0"]
ENDS_MEV = 1e-6  # its tolerance when it relaxes the ends


class Band:
    """A case in spirit: the Hamiltonian, both ends and a first path."""

    def __init__(self, case, images, start):
        self.case, self.images = case, images
        with tempfile.NamedTemporaryFile("w", suffix=".cfg") as file:
            file.write(self.config())
            file.flush()
            self.p = state.setup(file.name, True)
        chain.image_to_clipboard(self.p)
        chain.set_length(self.p, images)
        for image, spins in zip((0, images - 1), self.ends()):
            self.spins(image)[:] = spins
        self.clock, self.end_iterations = 0.0, 0
        if case["relax_ends"]:
            self.relax_ends()
        if start == "geodesic":
            transition.homogeneous(self.p, 0, images - 1)
        else:
            self.sweep()
        chain.update_data(self.p)

    def relax_ends(self):
        """Both ends to their minima: quasi-Newton, which is the quickest here."""
        for image in (0, self.images - 1):
            parameters.llg.set_convergence(self.p, ENDS_MEV, image)
            with self.running():
                info = simulation.start(self.p, simulation.METHOD_LLG, simulation.SOLVER_LBFGS_OSO, 10000, 10000, False, image)
            self.end_iterations += info.total_iterations

    def spins(self, image):
        return system.get_spin_directions(self.p, image)

    def barrier_mev(self):
        """The highest image above the first, in double precision: spirit's own energies come in single."""
        e = self.energies(np.array([self.spins(k) for k in range(self.images)]))
        return float(e.max() - e[0])

    def error(self):
        return abs(self.barrier_mev() / self.case["exact_meV"] - 1)

    def climb(self, which):
        """Lets images climb: the highest, or all maxima as spirit finds them."""
        with self.running():
            chain.update_data(self.p)
            if which == "all maxima":
                parameters.gneb.set_image_type_automatically(self.p)
            else:
                highest = int(np.argmax(chain.get_energy(self.p)[1:-1])) + 1
                parameters.gneb.set_climbing_falling(self.p, parameters.gneb.IMAGE_CLIMBING, highest)

    def start(self, solver, tolerance, iterations, single_shot=False):
        parameters.gneb.set_convergence(self.p, tolerance)
        number = getattr(simulation, "SOLVER_" + solver)
        with self.running():
            return simulation.start(self.p, simulation.METHOD_GNEB, number, iterations, iterations, single_shot)

    @contextlib.contextmanager
    def running(self):
        began = time.process_time()
        yield
        self.clock += time.process_time() - began

    def delete(self):
        state.delete(self.p)


class Chain(Band):
    """An open chain."""

    def __init__(self, case, images, start):
        self.k = np.array(case["K"])
        super().__init__(case, images, start)

    def config(self):
        return config(self.k)

    def ends(self):
        sites = np.arange(len(self.k))
        return ([0, 0, 1], [0, 0, -1]) if self.case["ends"] == "uniform" else (wall(sites, 45), wall(sites, 55))

    def energies(self, m):
        """Of all images, (image, site, xyz)."""
        bonds = J * (1 - np.einsum("kix,kix->ki", m[:, 1:], m[:, :-1])).sum(axis=1)
        return bonds + (self.k * (1 - m[:, :, 2] ** 2)).sum(axis=1)

    def sweep(self):
        """The hand-made path: a wall of the right width and profile enters at one end and leaves at the other."""
        sites, margin = np.arange(len(self.k)), 2.5 * WIDTH
        last = len(sites) - 1
        for image in range(1, self.images - 1):
            part = image / (self.images - 1)
            self.spins(image)[:] = wall(sites, last + margin - part * (last + 2 * margin))


class Film(Band):
    """A skyrmion in a periodic film, and the uniform state."""

    def config(self):
        n = self.case["cells"]
        lines = QUIET + ["boundary_conditions 1 1 0", f"external_field_magnitude {FIELD}", "external_field_normal 0 0 1"]
        lines += ["bravais_lattice sc", "hamiltonian heisenberg_neighbours", f"n_basis_cells {n} {n} 1", f"mu_s {MOMENT}"]
        lines += ["n_shells_exchange 1", f"jij {J}", "n_shells_dmi 1", f"dij {D}", "dm_chirality 1", "anisotropy_magnitude 0"]
        return "\n".join(lines) + "\n"

    def ends(self):
        """A skyrmion about a site, where it has its minimum, and all up."""
        n = self.case["cells"]
        y, x = np.mgrid[0:n, 0:n] - n // 2
        theta = 2 * np.arctan2(np.sinh(3 / 0.8), np.sinh(np.hypot(x, y) / 0.8))
        phi = np.arctan2(y, x) + np.pi / 2
        m = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)
        return m.reshape(-1, 3), [0, 0, 1]

    def energies(self, m):
        """Of all images, (image, site, xyz), above all up: −J m·n − D d·(m × n) a bond, −μ B m_z a site."""
        n = self.case["cells"]
        m = m.reshape(-1, n, n, 3)
        e = MOMENT * BOHR_MAGNETON * FIELD * (1 - m[..., 2])
        for axis, d in ((2, 0), (1, 1)):
            other = np.roll(m, -1, axis=axis)
            e += J * (1 - (m * other).sum(-1)) - D * np.cross(m, other)[..., d]
        return e.sum((1, 2))


def band(case, images, start):
    return (Film if "cells" in case else Chain)(case, images, start)


def wall(sites, centre):
    """+z left of the centre, through +x, −z right of it: the profile of the continuum."""
    z = -np.tanh((sites - centre) / WIDTH)
    return np.stack([np.sqrt(1 - z * z), 0 * z, z], axis=1)


def config(k):
    """Spirit's input: equal sites as one cell repeated, unequal ones as one cell with a basis; no output, no interpolation."""
    sites = len(k)
    lines = QUIET + ["boundary_conditions 0 0 0", "external_field_magnitude 0", "bravais_lattice sc"]
    if np.ptp(k) == 0:
        lines += ["hamiltonian heisenberg_neighbours", f"n_basis_cells {sites} 1 1", "mu_s 2", "n_shells_exchange 1", f"jij {J}"]
        lines += ["n_shells_dmi 0", f"anisotropy_magnitude {k[0]}", "anisotropy_normal 0 0 1"]
    else:
        lines += ["hamiltonian heisenberg_pairs", "n_basis_cells 1 1 1", "basis", str(sites)]
        lines += [f"{i / sites} 0 0" for i in range(sites)]
        lines += ["mu_s " + " ".join(["2"] * sites), f"n_anisotropy {sites}", "i K Kx Ky Kz"]
        lines += [f"{i} {value} 0 0 1" for i, value in enumerate(k)]
        lines += [f"n_interaction_pairs {sites - 1}", "i j da db dc Jij"]
        lines += [f"{i} {i + 1} 0 0 0 {J}" for i in range(sites - 1)]
    return "\n".join(lines) + "\n"


def scout_one(case, setting, targets, budget):
    """Follows one setting to spirit's tightest tolerance or to the end of the budget. For each target, a relative error of the
    barrier, the iterations from which on the barrier stays as near as that; for the target null, those at which spirit says
    that it has converged, if its barrier is right. A band still on the move when the budget ends counts if the barrier has been
    right for as long as it took to become so.
    """
    b = band(case, setting["images"], setting["start"])
    reached, done, n, error = {}, {}, 0, 1.0
    for phase in ("plain", "climbing"):
        if phase == "plain" and setting["plain_meV"] is None:
            done[phase] = 0
            continue
        if phase == "climbing":
            b.climb(setting["climb"])
        tolerance = setting["plain_meV"] if phase == "plain" else TIGHTEST_MEV
        b.start(setting["solver"], tolerance, 10**6, single_shot=True)
        n = 0
        while simulation.running_on_chain(b.p) and b.clock < budget:
            step = 1 + n // 50
            with b.running():
                simulation.n_shot(b.p, step)
            n += step
            error = b.error()
            for target in filter(None, targets):
                if error > target:
                    reached.pop(target, None)
                else:
                    reached.setdefault(target, {"phase": phase, "iterations": n, "cpu_s": b.clock})
        done[phase] = n
        simulation.stop(b.p)
    finished = b.clock < budget
    if finished and None in targets and error <= RIGHT:
        # A few more than it took here: in the run against the clock spirit itself is to stop.
        reached[None] = {"phase": "climbing", "iterations": n + 1000, "cpu_s": b.clock}
    b.delete()
    found = []
    for target, at in reached.items():
        if not finished and b.clock < 2 * at["cpu_s"]:
            continue
        plain = at["iterations"] if at["phase"] == "plain" else done["plain"]
        climbing = 0 if at["phase"] == "plain" else at["iterations"]
        found.append(dict(setting, target=target, plain=plain, climbing=climbing, cpu_s=at["cpu_s"]))
    return found


def scout(case, request):
    """For each target, the settings that reach it soonest, soonest first. A setting that takes more than four times as long as
    the best so far, for whichever target takes longest, is not followed to its end.
    """
    found, budget = [[] for _ in request["targets"]], request["budget_s"]
    keys = ("images", "solver", "plain_meV", "climb")
    tries = [dict(zip(keys, t)) for t in itertools.product(request["images"], SOLVERS, PLAIN_MEV, CLIMBING)]
    for setting in request.get("settings") or tries:
        setting = dict(setting, start=request["start"])
        for at in scout_one(case, setting, request["targets"], budget):
            found[request["targets"].index(at["target"])].append(at)
        if all(found):
            budget = min(budget, 4 * max(min(at["cpu_s"] for at in each) for each in found))
    return [sorted(each, key=lambda at: at["cpu_s"])[: request["keep"]] for each in found]


def solve(case, s):
    """One setting against the clock, with as many iterations as the scout found, or until spirit says it has converged."""
    b = band(case, s["images"], s["start"])
    iterations, says = 0, False
    if s["plain"]:
        iterations += b.start(s["solver"], s["plain_meV"], s["plain"]).total_iterations
    if s["climbing"]:
        b.climb(s["climb"])
        info = b.start(s["solver"], TIGHTEST_MEV, s["climbing"])
        iterations += info.total_iterations
        says = info.total_iterations < s["climbing"]
    evaluations = iterations * (s["images"] - 2) + b.end_iterations
    barrier = dict(barrier_meV=b.barrier_mev(), error=b.error())
    return barrier | dict(cpu_s=b.clock, iterations=iterations, evaluations=evaluations, converged=says)


def main():
    request = json.loads(sys.argv[1])
    case = CASES[request["case"]]
    # Spirit greets on stdout; the answer goes to the true one.
    out = os.dup(1)
    os.dup2(2, 1)
    answer = scout(case, request) if request["do"] == "scout" else solve(case, request)
    os.write(out, (json.dumps(answer) + "\n").encode())


if __name__ == "__main__":
    main()
