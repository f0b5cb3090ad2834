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
CONVERGED = dict(solver="LBFGS_OSO", plain_meV=1e-4, climb="all maxima", plain=10000, climbing=10000)
NEAR, NEARER = 1e-6, 1e-9  # relative errors of the barrier at which spirit's clock stops
TWENTY, ANY = [20], [5, 7, 10, 11, 14, 15, 20, 21]

# What spirit is given: the start, the numbers of images to try, the error to reach (None: run until it says it is done), and
# the CPU seconds a setting may take in the search for the best ones.
ROWS = {
    "nucleation": [
        ("geodesic", [21], None, 0),
        ("geodesic", TWENTY, NEAR, 4.0),
        ("sweep", TWENTY, NEAR, 1.0),
        ("sweep", TWENTY, NEARER, 1.0),
        ("sweep", ANY, NEAR, 0.5),
        ("sweep", ANY, NEARER, 0.5),
    ],
    "depinning, K doubled": [(("geodesic"), images, target, 0.6) for images in (TWENTY, ANY) for target in (NEAR, NEARER)],
    "depinning, K halved": [(("geodesic"), images, target, 0.6) for images in (TWENTY, ANY) for target in (NEAR, NEARER)],
}


def main():
    a = arguments()
    tables, goals = {}, []
    for name in CASES:
        say(f"{name}: looking for spirit's best settings")
        rows = candidates(name)
        for turn in range(a.repeat):
            say(f"{name}: repetition {turn + 1} of {a.repeat}")
            # In turn, so that what else the machine does falls on both alike.
            own = [row for row in rows if row["program"] == "spinneb"]
            for row in rows:
                if row["program"] == "spirit":
                    for setting in row["settings"]:
                        setting["runs"].append(spirit("solve", name, setting))
            for row in own:
                row["runs"].append(spinneb(a.spinneb, name))
        tables[name] = [judge(row, name) for row in rows]
        goals.append(goal(name, tables[name]))
    show(tables, a.markdown)
    print("\n".join(("- " if a.markdown else "") + line for line in goals))


def arguments():
    p = argparse.ArgumentParser(prog="run.sh", description="Compares spinneb with spirit on one thread.")
    p.add_argument("--spinneb", required=True, help=argparse.SUPPRESS)
    p.add_argument("--repeat", type=int, default=5, help="repetitions of every run; the least time counts (default 5)")
    p.add_argument("--markdown", action="store_true", help="print the tables as Markdown")
    return p.parse_args()


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
    done = subprocess.run(one_thread() + command, cwd=ROOT, env=dict(os.environ, OMP_NUM_THREADS="1"), capture_output=True, text=True)
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


def spinneb(program, case):
    """A run of the config as it is shipped, but for files of results: spirit writes none either."""
    with tempfile.TemporaryDirectory() as folder:
        quiet = ["--out", folder + "/out", "--threads", "1", "--quiet", "--set", "output.formats=[]", "--set", "output.plots=[]"]
        process = child([program, "run", CASES[case]["config"], *quiet])[1]
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
        images=summary["path"]["images"],
    )


def candidates(case):
    """The rows of a case's table, each with the settings that may turn out the best."""
    rows = [dict(program="spinneb", runs=[])]
    for start, images, target, budget in ROWS[case]:
        if target is None:
            settings = [dict(CONVERGED, start=start, images=images[0], target=None)]
        else:
            wanted = dict(start=start, images=images, targets=[target], budget_s=budget, keep=4)
            settings = spirit("scout", case, wanted)[0]
        if not settings:
            say(f"{case}: no setting of spirit's came within {target} from the {start}")
        rows.append(dict(program="spirit", start=start, any=len(images) > 1, target=target, settings=[s | {"runs": []} for s in settings]))
    return rows


def least(runs):
    """The result of a set of equal runs, with the least times of each kind."""
    return runs[0] | {k: min(r[k] for r in runs) for k in ("cpu_s", "process_s")}


def judge(row, case):
    """The quickest of a row's settings that got as near as it should, as cells of the table; numbers still as numbers."""
    if row["program"] == "spinneb":
        r = least(row["runs"])
        return r | dict(who="spinneb", given="the two ends", images=r["images"], stop="certified" if r["certified"] else "not certified")
    target = row["target"]
    tried = [s | least(s["runs"]) for s in row["settings"]]
    tried = [s for s in tried if target is None or s["error"] <= target]
    if not tried:
        return dict(who="spirit", given=row["start"], stop=f"never within {target:.0e}", right=False)
    best = min(tried, key=lambda s: s["cpu_s"])
    given = {"geodesic": "geodesic", "sweep": "hand-made sweep"}[row["start"]] + (", images to suit" if row["any"] else "")
    stop = "says converged" if target is None else f"within {target:.0e}"
    return best | dict(who=f"spirit, {how(best)}", given=given, stop=stop, right=best["error"] <= NEAR, certified=None)


def how(s):
    """A setting in words."""
    if not s["climbing"]:
        return f"{s['solver']}, no climbing"
    first = f"after {s['plain_meV']:.0e} meV" if s["plain"] else "at once"
    return f"{s['solver']}, {s['climb']} climbing {first}"


def goal(name, table):
    """The goal of a case against the quickest right answer of spirit's; from the hand-made path, where there is one."""
    own = table[0]
    rows = [r for r in table[1:] if r.get("right")]
    rows = [r for r in rows if "sweep" in r["given"]] or rows
    if not rows:
        return f"{name}: spirit found no right barrier, so there is nothing to compare with"
    ratio = min(r["cpu_s"] for r in rows) / own["cpu_s"]
    met = "met" if ratio >= CASES[name]["goal"] and own["certified"] else "NOT met"
    return f"{name}: goal of 1/{CASES[name]['goal']} of spirit's best CPU time {met}: spirit's best takes {ratio:.2g} times spinneb's"


HEAD = ["program", "given", "images", "stops", "CPU ms, solving", "CPU ms, process", "evaluations", "barrier (meV)", "relative error", "certified", "times spinneb's"]


def cells(row, own):
    if "cpu_s" not in row:
        return [row["who"], row["given"], "", row["stop"]] + [""] * 7
    right = row["error"] <= NEAR
    return [
        row["who"],
        row["given"],
        str(row["images"]),
        row["stop"],
        f"{row['cpu_s'] * 1e3:.3g}",
        f"{row['process_s'] * 1e3:.0f}",
        str(row["evaluations"]),
        f"{row['barrier_meV']:.9f}",
        f"{row['error']:.0e}" if right else f"{row['error']:.2g}: wrong",
        {True: "yes", False: "no", None: "–"}[row["certified"]],
        f"{row['cpu_s'] / own['cpu_s']:.2g}" if right else "",
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
