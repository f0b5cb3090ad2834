"""Landscapes of random chains by spinneb against an enumeration of its own kind: campaign.py SPINNEB [--first K] [--chains N]

For each chain and effort: are all minima and saddles there that lie on any lowest way between two of the ten lowest minima, and is
each state that is there stationary, of its index? What either of the two finds counts, once it is seen here to be a minimum or a
saddle of index one.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

# before numpy is loaded
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from chains import FAMILIES, chain
from enumeration import SAME_ENERGY, enumerated

EFFORTS = ("normal", "thorough")
LARGEST_TORQUE = 1e-9


def landscape_of(spinneb, config, effort, folder):
    """What the program finds, and the seconds of a processor that it takes."""
    path, out = Path(folder) / "config.json", Path(folder) / effort
    path.write_text(json.dumps(config))
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    command = [spinneb, "landscape", path, "--effort", effort, "--out", out, "--quiet", "--threads", "1"]
    done = subprocess.run(command, capture_output=True, text=True)
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    # 3: the work that it may do was spent
    if done.returncode not in (0, 3):
        sys.exit(f"{config['name']}: exit code {done.returncode}\n{done.stderr}")
    with np.load(out / "landscape.npz") as arrays:
        return {key: arrays[key] for key in ("minima", "saddles")}, seconds


def states(surface, found):
    """States of the program as they are here, and their energies."""
    m = surface.whole(found[:, surface.free] if len(found) else np.zeros((0, len(surface.free), 3)))
    return m, surface.chain.slopes(m)[0]


def wrong(surface, found):
    """How many of its states are not stationary or not of the index that they should have."""
    count = 0
    for key, index in (("minima", 0), ("saddles", 1)):
        torque, negative, _ = surface.index(states(surface, found[key])[0])
        count += int(((torque > LARGEST_TORQUE) | (negative != index)).sum())
    return count


def bring(landscape, found, ceiling_mev):
    """Puts in what the program found, as far as it is what it should be and no higher than is wanted."""
    surface = landscape.surface
    landscape.add_minima(states(surface, found["minima"])[0])
    m, energies = states(surface, found["saddles"])
    torque, negative, _ = surface.index(m)
    good = (torque < LARGEST_TORQUE) & (negative == 1) & (energies <= ceiling_mev)
    landscape.add_saddles(list(zip(m[good], energies[good])))


def missing(landscape, found, wanted):
    """Of the wanted minima and saddles how many are not there."""
    left = []
    for known, key, which in zip((landscape.minima, landscape.saddles), ("minima", "saddles"), wanted):
        there = {known.find(state, energy) for state, energy in zip(*states(landscape.surface, found[key]))}
        left.append(len(which - there))
    return left


def compared(spinneb, number):
    """A chain's row."""
    family, made = chain(number)
    begun = time.process_time()
    landscape, climbs, closed = enumerated(made, [2102, number])
    row = {"family": family, "number": number, "sites": made.sites, "climbs": climbs, "closed": closed}
    row["enumeration_s"] = time.process_time() - begun
    with tempfile.TemporaryDirectory() as folder:
        results = {effort: landscape_of(spinneb, made.config, effort, folder) for effort in EFFORTS}
    own = len(landscape.saddles.energies)
    ceiling = max(landscape.tops()[0].values(), default=np.inf) + SAME_ENERGY * landscape.surface.scale
    for found, _ in results.values():
        bring(landscape, found, ceiling)
    wanted = landscape.on_routes()
    row["wanted"] = [len(part) for part in wanted]
    row["not_enumerated"] = sum(k >= own for k in wanted[1])
    for effort, (found, seconds) in results.items():
        row[effort] = {
            "missing": missing(landscape, found, wanted),
            "wrong": wrong(landscape.surface, found),
            "found": [len(found["minima"]), len(found["saddles"])],
            "seconds": seconds,
        }
    return row


def table(rows):
    """A line for each family that was looked at."""
    head = ["family", "chains", "minima + saddles wanted"]
    for effort in EFFORTS:
        head += [f"{effort}: chains with all", "missing", "seconds"]
    lines = [head, ["---"] * len(head)]
    for family in [*FAMILIES, "all"]:
        own = [r for r in rows if family in ("all", r["family"])]
        if not own:
            continue
        cells = [family.replace("_", " "), len(own), " + ".join(str(sum(r["wanted"][k] for r in own)) for k in (0, 1))]
        for effort in EFFORTS:
            lost = [sum(r[effort]["missing"]) for r in own]
            cells += [lost.count(0), sum(lost), f"{sum(r[effort]['seconds'] for r in own):.1f}"]
        lines.append(cells)
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


def summary(rows):
    """What the table does not tell."""
    found = sum(sum(r[effort]["found"]) for r in rows for effort in EFFORTS)
    bad = sum(r[effort]["wrong"] for r in rows for effort in EFFORTS)
    seconds = sum(r["enumeration_s"] for r in rows)
    return (
        f"{bad} of {found} states that the program lists are not stationary or not of their index. The enumeration took "
        f"{sum(r['climbs'] for r in rows)} climbs and {seconds:.0f} s, ended before it was quiet in {sum(not r['closed'] for r in rows)} "
        f"chains, and lacked {sum(r['not_enumerated'] for r in rows)} of the wanted saddles, which the program has."
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("spinneb", help="the program")
    parser.add_argument("--first", type=int, default=0, help="number of the first chain")
    parser.add_argument("--chains", type=int, default=100, help="how many chains")
    asked = parser.parse_args()
    rows = []
    for number in range(asked.first, asked.first + asked.chains):
        rows.append(compared(asked.spinneb, number))
        print(json.dumps(rows[-1]), file=sys.stderr, flush=True)
    print(table(rows))
    print()
    print(summary(rows))


if __name__ == "__main__":
    main()
