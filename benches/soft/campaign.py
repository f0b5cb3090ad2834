"""Random soft films with DMI, each at `normal` and at `thorough`: campaign.py SPINNEB [--first K] [--films N]"""

import argparse
import json
import random
import subprocess
import sys
import tempfile
from pathlib import Path

LOWER = 1e-6  # of the barrier


def film(number):
    """A small film whose uniform state and skyrmions are metastable at best."""
    r = random.Random(number)
    nx, ny = r.randint(6, 12), r.randint(6, 12)
    uniform = [[0, 0, 1], [0, 0, -1], [1, 0, 0.3]]
    skyrmion = lambda: {"skyrmion": {"radius": r.choice([2, 3]), "center": [r.randint(1, nx - 2), r.randint(1, ny - 2)]}}
    state = lambda: skyrmion() if r.random() < 0.5 else {"uniform": {"direction": r.choice(uniform)}}
    initial, final = state(), state()
    while final == initial:
        final = state()
    energy = [
        {"exchange": {"J": ["1 meV"]}},
        {"dmi": {"D": f"{r.uniform(0.25, 0.75):.3f} meV", "kind": "interfacial"}},
        {"anisotropy": {"K": f"{r.uniform(0.0, 0.3):.3f} meV", "axis": [0, 0, 1]}},
        {"zeeman": {"B": ["0 T", "0 T", f"{r.uniform(0.0, 1.0):.2f} T"]}},
    ]
    cells = {"cells": [nx, ny], "periodic": [r.random() < 0.5, r.random() < 0.5]}
    return {
        "name": f"soft_film_{number}",
        "material": {"name": "soft", "source": "random", "moment": "2 mu_B", "energy": energy},
        "lattice": {r.choice(["square", "triangular"]): cells},
        "initial": initial,
        "final": final,
    }


def outcome(spinneb, config, effort, folder):
    """The barrier (meV), whether it is certified, and the searches; no barrier where both ends relax to one minimum."""
    path, out = Path(folder) / "film.json", Path(folder) / "out"
    path.write_text(json.dumps(config))
    command = [spinneb, "run", path, "--out", out, "--force", "--quiet", "--effort", effort]
    done = subprocess.run(command, capture_output=True, text=True)
    # 3: not certified
    if done.returncode not in (0, 3):
        sys.exit(f"exit code {done.returncode}\n{done.stderr}")
    summary = json.loads((out / "summary.json").read_text())
    return (summary["barrier_meV"] or {}).get("forward"), summary["certified"], summary["search"]["searches"]


def main():
    p = argparse.ArgumentParser(description="How often normal misses a barrier that thorough finds.")
    p.add_argument("spinneb", type=lambda p: str(Path(p).resolve()), help=argparse.SUPPRESS)
    p.add_argument("--first", type=int, default=0, help="the number of the first film (default 0)")
    p.add_argument("--films", type=int, default=100, help="how many films (default 100)")
    a = p.parse_args()
    count = {"films with a barrier": 0, "certified by both": 0, "normal higher": 0, "thorough higher": 0}
    for number in range(a.first, a.first + a.films):
        with tempfile.TemporaryDirectory() as folder:
            found = [outcome(a.spinneb, film(number), effort, folder) for effort in ("normal", "thorough")]
        (normal, is_sure, few), (thorough, is_surer, many) = found
        if normal is None or thorough is None:
            continue
        both = is_sure and is_surer
        higher = [both and x > y + LOWER * abs(y) for x, y in ((normal, thorough), (thorough, normal))]
        for name, adds in zip(count, (True, both, *higher)):
            count[name] += adds
        print(f"{number}: {normal:.6f} meV in {few} searches, {thorough:.6f} meV in {many}", flush=True)
    print(", ".join(f"{name} {n}" for name, n in count.items()))


main()
