"""Spinneb and spirit side by side on one thread: see README.md. Started by run.sh."""

import argparse
import json
import os
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from cases import CASES

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
NEAR, NEARER = 1e-6, 1e-9  # relative errors of the barrier at which spirit's clock stops
DONE = None  # the clock stops when spirit says that it has converged
TWENTY, MANY = [20], [5, 7, 10, 11, 14, 15, 20, 21]  # numbers of images
AS_IT_COMES = dict(start="geodesic", images=21, solver="LBFGS_OSO", plain_meV=1e-4, climb="all maxima", plain=10000, climbing=10000)


def search(start, images, targets, budget):
    """A search for spirit's best settings; no setting takes more than the budget, in CPU seconds."""
    return dict(start=start, images=images, targets=targets, budget_s=budget, keep=4)


SEARCHES = {
    "nucleation": [
        search("geodesic", TWENTY, [DONE], 5.0),
        search("geodesic", TWENTY, [NEAR], 2.0),
        search("sweep", TWENTY, [DONE, NEARER, NEAR], 2.0),
        search("sweep", MANY, [NEARER, NEAR], 0.5),
    ],
    "depinning, K doubled": [search("geodesic", TWENTY, [DONE, NEARER, NEAR], 1.0), search("geodesic", MANY, [NEARER, NEAR], 0.5)],
    "depinning, K halved": [search("geodesic", TWENTY, [DONE, NEARER, NEAR], 1.0), search("geodesic", MANY, [NEARER, NEAR], 0.5)],
    "collapse, 30²": [search("geodesic", TWENTY, [DONE, NEAR], 6.0), search("geodesic", MANY, [DONE, NEAR], 3.0)],
    "collapse, 64²": [search("geodesic", TWENTY, [DONE, NEAR], 60.0), search("geodesic", MANY, [DONE, NEAR], 30.0)],
    "collapse, 128²": [search("geodesic", TWENTY, [DONE, NEAR], 240.0), search("geodesic", MANY, [DONE, NEAR], 120.0)],
}
# Searching all settings takes hours on the larger films: tried is what was quickest on the smaller one.
SETTINGS_OF = {"collapse, 64²": "collapse, 30²", "collapse, 128²": "collapse, 64²"}


def main():
    a = arguments()
    tables, goals, found = {}, [], {}
    for name in a.case or CASES:
        say(f"{name}: looking for spirit's best settings")
        rows = candidates(name, found, a.spinneb)
        for turn in range(a.repeat):
            say(f"{name}: repetition {turn + 1} of {a.repeat}")
            # In turn, so that what else the machine does falls on both alike.
            for row in rows:
                if row["program"] == "spinneb":
                    row["runs"].append(spinneb(a.spinneb, name, row["certify"], row["images"]))
                for setting in row.get("settings", []):
                    setting["runs"].append(spirit("solve", name, setting))
        tables[name] = [judge(row, name) for row in rows]
        goals.append(goal(name, tables[name]))
    show(tables, a.markdown)
    print("\n".join(("- " if a.markdown else "") + line for line in goals))


def arguments():
    p = argparse.ArgumentParser(prog="run.sh", description="Compares spinneb with spirit on one thread.")
    p.add_argument("--spinneb", required=True, type=lambda p: str(Path(p).resolve()), help=argparse.SUPPRESS)
    p.add_argument("--repeat", type=positive, default=5, help="repetitions of every run; the least time counts (default 5)")
    p.add_argument("--case", action="append", choices=list(CASES), help="only this one (may be given several times)")
    p.add_argument("--markdown", action="store_true", help="print the tables as Markdown")
    return p.parse_args()


def positive(word):
    if int(word) < 1:
        raise ValueError
    return int(word)


def say(words):
    print(words, file=sys.stderr, flush=True)


def one_thread():
    """The start of a command that keeps to one core, where the system can."""
    if shutil.which("taskset"):
        return ["taskset", "-c", str(max(os.sched_getaffinity(0)))]
    return []


def child(command):
    """Runs a program; its stdout and the CPU seconds of the whole process."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    alone = dict(os.environ, OMP_NUM_THREADS="1")
    done = subprocess.run(one_thread() + command, cwd=ROOT, env=alone, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    # 3: finished but not certified, which the table shows.
    if done.returncode not in (0, 3):
        sys.exit(f"{' '.join(command)} ended with {done.returncode}:\n{done.stderr}")
    return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def spirit(do, case, request):
    """A request to spirit in a process of its own."""
    words = json.dumps({k: v for k, v in request.items() if k != "runs"} | {"do": do, "case": case})
    out, process = child([sys.executable, str(HERE / "spirit_case.py"), words])
    answer = json.loads(out)
    if do == "solve":
        answer["process_s"] = process
    return answer


def spinneb(program, case, certify, images=None):
    """A run of the config as it is shipped, but for files of results, as spirit writes none either; without the certificate on
    demand, as spirit has none either; with so many images, if they are given.
    """
    with tempfile.TemporaryDirectory() as folder:
        quiet = ["--out", folder + "/out", "--threads", "1", "--quiet", "--set", "output.formats=[]", "--set", "output.plots=[]"]
        quiet += [] if certify else ["--set", "saddle.certify=false"]
        quiet += ["--set", f"path.images={images}"] if images else []
        process = child([program, "run", CASES[case]["config"], *CASES[case].get("set", []), *quiet])[1]
        summary = json.loads(Path(folder, "out", "summary.json").read_text())
    barrier = summary["barrier_meV"]["forward"]
    return dict(
        # Its own clock is wall time; on one thread the CPU time of the same work is at most that, and at most the process's.
        cpu_s=min(summary["work"]["seconds"], process),
        process_s=process,
        evaluations=summary["work"]["force_evaluations"],
        barrier_meV=barrier,
        error=abs(barrier / CASES[case]["exact_meV"] - 1),
        certified=summary["certified"],
        converged=summary["converged"],
        images=summary["path"]["images"],
    )


def candidates(case, found, program):
    """The rows of a case's table, each with the settings that may turn out the best; `found` keeps those of all cases, search by
    search.
    """
    rows = [dict(program="spinneb", certify=certify, images=None, runs=[]) for certify in (True, False)]
    if CASES[case].get("suits"):
        quickest = min(MANY, key=lambda images: spinneb(program, case, True, images)["cpu_s"])
        rows.append(dict(program="spinneb", certify=True, images=quickest, runs=[]))
    if case == "nucleation":
        rows.append(dict(program="spirit", target=DONE, any=False, settings=[AS_IT_COMES | {"runs": []}]))
    smaller = found.get(SETTINGS_OF.get(case), [None] * len(SEARCHES[case]))
    found[case] = []
    for wanted, known in zip(SEARCHES[case], smaller):
        answers = spirit("scout", case, wanted | {"settings": known})
        found[case].append([{k: s[k] for k in ("images", "solver", "plain_meV", "climb")} for a in answers for s in a[:2]])
        for target, settings in zip(wanted["targets"], answers):
            if not settings:
                say(f"{case}: from the {wanted['start']}, none of spirit's settings reached {stop(target)}")
                continue
            settings = [s | {"runs": []} for s in settings]
            rows.append(dict(program="spirit", target=target, any=len(wanted["images"]) > 1, settings=settings))
    return rows


def short(number):
    """As 1e-6."""
    return f"{number:.0e}".replace("e-0", "e-")


def stop(target):
    """When spirit's clock stops, in words."""
    return "says converged" if target is DONE else f"within {short(target)}"


def least(runs):
    """The result of a set of equal runs, with the least times of each kind."""
    return runs[0] | {k: min(r[k] for r in runs) for k in ("cpu_s", "process_s")}


def judge(row, case):
    """The quickest of a row's settings, as cells of the table; numbers still as numbers."""
    if row["program"] == "spinneb":
        r = least(row["runs"])
        who = "spinneb" if row["certify"] else "spinneb, asked for no certificate"
        words = stop(DONE) if r["converged"] else "not converged"
        given = CASES[case]["given"] + (", images to suit" if row["images"] else "")
        return r | dict(who=who, given=given, stop=words, right=r["error"] <= NEAR)
    best = min((s | least(s["runs"]) for s in row["settings"]), key=lambda s: s["cpu_s"])
    given = {"geodesic": "geodesic", "sweep": "hand-made sweep"}[best["start"]] + (", images to suit" if row["any"] else "")
    # A stop that the run against the clock did not confirm is not to pass for one.
    kept = best["converged"] if row["target"] is DONE else best["error"] <= row["target"]
    words = stop(row["target"]) if kept else "does not stop as in the search"
    return best | dict(who=f"spirit, {how(best)}", given=given, stop=words, right=kept and best["error"] <= NEAR, certified=None)


def how(s):
    """A setting in words."""
    if not s["climbing"]:
        return f"{s['solver']}, no climbing"
    first = f"after {short(s['plain_meV'])} meV" if s["plain"] else "at once"
    return f"{s['solver']}, {s['climb']} climbing {first}"


def goal(name, table):
    """The goal of a case against the quickest right answer that spirit says it has converged to with 20 images, from the
    hand-made path where there is one; beside it, the ratio where the clock stops with knowledge of the answer.
    """
    own, wanted = table[0], CASES[name]["goal"]
    rows = [r for r in table if r["who"].startswith("spirit") and r["right"]]
    rows = [r for r in rows if "sweep" in r["given"]] or rows
    unaided = [r["cpu_s"] / own["cpu_s"] for r in rows if r["stop"] == stop(DONE)]
    if not unaided:
        return f"{name}: spirit found no right barrier by itself, so there is nothing to compare with"
    met = "met" if min(unaided) >= wanted and own["certified"] and own["right"] else "NOT met"
    aided = min(r["cpu_s"] for r in rows) / own["cpu_s"]
    words = f"{name}: the goal, 1/{wanted} of the CPU time of spirit's best until it says that it has converged, is {met}"
    return f"{words}: {ratio(min(unaided))} times; with the answer known and images to suit, {ratio(aided)} times"


def ratio(x):
    """Two digits, or all before the point."""
    return f"{x:.0f}" if x >= 10 else f"{x:.2g}"


HEAD = ["program", "given", "images", "stops", "CPU ms, solving", "CPU ms, process", "evaluations"]
HEAD += ["barrier (meV)", "relative error", "certified", "CPU time over spinneb's"]


def cells(row, own):
    return [
        row["who"],
        row["given"],
        str(row["images"]),
        row["stop"],
        f"{row['cpu_s'] * 1e3:.1f}",
        f"{row['process_s'] * 1e3:.0f}",
        str(row["evaluations"]),
        f"{row['barrier_meV']:.9f}",
        short(row["error"]) if row["right"] else f"{row['error']:.2g}: wrong",
        {True: "yes", False: "no", None: "–"}[row["certified"]],
        ratio(row["cpu_s"] / own["cpu_s"]) if row["right"] else "",
    ]


def show(tables, markdown):
    for name, table in tables.items():
        lines = [HEAD] + [cells(row, table[0]) for row in table]
        widths = [max(len(line[i]) for line in lines) for i in range(len(HEAD))]
        print(f"### {name}\n" if markdown else f"{name}")
        for n, line in enumerate(lines):
            padded = [cell.ljust(w) for cell, w in zip(line, widths)]
            print("| " + " | ".join(line) + " |" if markdown else "  ".join(padded).rstrip())
            if markdown and n == 0:
                print("|" + "---|" * len(HEAD))
        print()


if __name__ == "__main__":
    main()
