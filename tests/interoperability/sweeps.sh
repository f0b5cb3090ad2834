#!/bin/sh
# The examples of sweeps by other programs: tests/interoperability/sweeps.sh [--venv DIR]
# Runs examples/sweeps by GNU parallel, by Snakemake, by a local cluster of HyperQueue and by the lines of the Slurm array, and
# compares each table with that of a local sweep, byte by byte. Installs parallel by apt-get (as root), Snakemake and HyperQueue
# into a virtual environment (a temporary one unless DIR is given). Exit code 77: a program cannot be had here, and which one is said; the others are checked all the same.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
venv=$work/venv
if [ "${1:-}" = "--venv" ]; then
    [ $# -ge 2 ] || { echo "sweeps.sh: --venv needs a folder" >&2; exit 2; }
    venv=$2
fi
code=0
cannot() {
    echo "sweeps: NOT CHECKED: $*" >&2
    code=77
}
debian() {
    [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null &&
        { apt-get update -qq && apt-get install -qq -y --no-install-recommends "$1"; } >/dev/null 2>&1
}

. "$here/../venv.sh"
cargo build --release --quiet --manifest-path "$root/Cargo.toml"
PATH=$(cd "${CARGO_TARGET_DIR:-$root/target}/release" && pwd):$PATH
export PATH

# A copy of the example, and its table by one command.
prepare() {
    mkdir -p "$work/$1/examples"
    cp -R "$root/configs" "$work/$1/configs"
    cp -R "$root/examples/sweeps" "$work/$1/examples/sweeps"
    rm -rf "$work/$1/examples/sweeps/results"
    cd "$work/$1/examples/sweeps"
}
prepare local
spinneb sweep field.json --quiet
expected=$PWD/results/field/barriers.csv
[ "$(wc -l <"$expected")" = 16 ] || { echo "sweeps: the table has not a row for each of 15 points" >&2; exit 1; }
[ "$(grep -c ',certified,sites_' "$expected")" = 15 ] || { echo "sweeps: a point is not certified" >&2; exit 1; }
compare() {
    cmp "$expected" results/field/barriers.csv
    echo "sweeps: $1: the table is that of a local sweep"
}

prepare array
last=$(($(spinneb sweep field.json --count) - 1))
for task in $(seq 0 "$last"); do
    SLURM_ARRAY_TASK_ID=$task sh array.sh 2>/dev/null
done
spinneb collect field.json --quiet
compare "the lines of the Slurm array, without Slurm"

if command -v parallel >/dev/null || debian parallel; then
    prepare parallel
    sh parallel.sh 2>/dev/null
    [ "$(wc -l <field.log)" = 16 ] || { echo "sweeps: parallel has not run 15 points" >&2; exit 1; }
    compare "$(parallel --version | head -1)"
else
    cannot "GNU parallel is not there and cannot be installed"
fi

snakemake=$venv/bin/snakemake
if [ ! -x "$snakemake" ]; then
    venv "$venv" &&
        "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-compile snakemake==9.13.4 >/dev/null 2>&1 || true
fi
if [ -x "$snakemake" ]; then
    prepare snakemake
    "$snakemake" --cores 2 --quiet all >snakemake.log 2>&1 || { cat snakemake.log >&2; exit 1; }
    compare "Snakemake $("$snakemake" --version)"
    "$snakemake" --cores 1 --dry-run 2>&1 | grep -q "Nothing to be done" ||
        { echo "sweeps: Snakemake would run again what is done" >&2; exit 1; }
else
    cannot "Snakemake 9.13.4 cannot be installed: is there a network, and Python 3.11 or later?"
fi

if [ -x "$venv/bin/python" ] &&
    { "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-compile hyperqueue==0.27.0 >/dev/null 2>&1 ||
        "$venv/bin/python" -c "import hyperqueue" 2>/dev/null; }; then
    prepare hyperqueue
    "$venv/bin/python" tasks.py >hyperqueue.log 2>&1 || { cat hyperqueue.log >&2; exit 1; }
    compare "HyperQueue 0.27.0, a local cluster"
else
    cannot "HyperQueue 0.27.0 cannot be installed: is there a network?"
fi
exit "$code"
