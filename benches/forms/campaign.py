"""Equivalent forms of random films have one barrier: campaign.py SPINNEB [--first K] [--films N] [--effort EFFORT]"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from films import config, disordered, forms, ordered

SAME = 1e-8  # of the barrier


def barrier_mev(spinneb, written, effort, folder):
    """Forward and backward, and whether they are certified."""
    path, out = Path(folder) / "film.json", Path(folder) / "out"
    path.write_text(json.dumps(written))
    command = [spinneb, "run", path, "--out", out, "--force", "--quiet", "--threads", "1", "--effort", effort]
    done = subprocess.run(command, capture_output=True, text=True)
    # 3: not certified
    if done.returncode not in (0, 3):
        sys.exit(f"exit code {done.returncode}\n{done.stderr}")
    summary = json.loads((out / "summary.json").read_text())
    barrier = summary["barrier_meV"] or {}
    return barrier.get("forward"), barrier.get("backward"), summary["certified"]


def compared(spinneb, film, number, effort):
    """What the forms say of a film: "same", or what differs."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for form, how in forms(film, number).items():
            forward, backward, certified = barrier_mev(spinneb, config(film, **how), effort, folder)
            found[form] = (backward if how.get("exchanged") else forward, certified)
    if not all(certified for _, certified in found.values()):
        return "not certified: " + ", ".join(form for form, (_, certified) in found.items() if not certified)
    low, high = (pick(mev for mev, _ in found.values()) for pick in (min, max))
    if high - low <= SAME * high:
        return "same"
    return "; ".join(f"{form} {mev:.6f} meV" for form, (mev, _) in found.items())


def main():
    p = argparse.ArgumentParser(prog="run.sh", description="Compares the barriers of equivalent forms of random films.")
    p.add_argument("spinneb", type=lambda p: str(Path(p).resolve()), help=argparse.SUPPRESS)
    p.add_argument("--first", type=int, default=0, help="the number of the first film of either kind (default 0)")
    p.add_argument("--films", type=int, default=100, help="films of either kind (default 100)")
    p.add_argument("--effort", default="normal", choices=["none", "quick", "normal", "thorough"])
    a = p.parse_args()
    for name, make in (("ordered", ordered), ("disordered", disordered)):
        differ = 0
        for number in range(a.first, a.first + a.films):
            kind, film = make(number)
            said = compared(a.spinneb, film, number, a.effort)
            differ += said != "same"
            print(f"{name} {number} {kind}, {film.cells[0]} by {film.cells[1]}: {said}", flush=True)
        print(f"{name}: the forms of {differ} of {a.films} films differ", flush=True)


if __name__ == "__main__":
    main()
