#!/bin/sh
# Files of spins against the programs of others: tests/interoperability/run.sh [--venv DIR]
# Installs discretisedfield, ovf (libovf), vtk, PyGT, networkx and numpy into a virtual environment (a temporary one unless DIR is given), builds
# spinneb, and checks that each reads what the other writes. Exit code 77: the check cannot run here, and why is said.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
cannot() {
    echo "interoperability: NOT CHECKED: $*" >&2
    exit 77
}
venv=
if [ "${1:-}" = "--venv" ]; then
    [ $# -ge 2 ] || { echo "run.sh: --venv needs a folder" >&2; exit 2; }
    venv=$2
fi
if [ -z "$venv" ]; then
    venv=$(mktemp -d)
    trap 'rm -rf "$venv"' EXIT
fi
if [ ! -x "$venv/bin/python" ] && ! python3 -m venv "$venv" >/dev/null 2>&1; then
    [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null || cannot "there is no python3 with venv, and only root can install it"
    { apt-get update -qq && apt-get install -qq -y --no-install-recommends python3-venv; } >/dev/null 2>&1 ||
        cannot "apt-get cannot install python3-venv"
    python3 -m venv "$venv" >/dev/null 2>&1 || cannot "python3 cannot make a virtual environment"
fi
pip() {
    "$venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-compile --only-binary :all: "$@"
}
usual="numpy==2.2.6 matplotlib==3.10.3 vtk==9.5.0"
# a system may have no wheels of the last two: check.py says which of them it used
# shellcheck disable=SC2086
pip $usual discretisedfield==0.92.0 ovf==0.4.3 || pip $usual discretisedfield==0.92.0 || pip $usual ||
    cannot "numpy, matplotlib and vtk cannot be installed: is there a network?"
pip PyGT==0.3.0 networkx==3.4.2 || pip networkx==3.4.2 || true
cargo build --release --quiet --manifest-path "$root/Cargo.toml"
export PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=Agg
"$venv/bin/python" "$here/check.py" "${CARGO_TARGET_DIR:-$root/target}/release/spinneb" "$root/docs/src/python.md"
