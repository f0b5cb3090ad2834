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
. "$here/../venv.sh"
venv "$venv"
usual="numpy==2.2.6 matplotlib==3.10.3 vtk==9.5.0"
# a system may have no wheels of the last two: check.py says which of them it used
# shellcheck disable=SC2086
wheels "$venv" $usual discretisedfield==0.92.0 ovf==0.4.3 || wheels "$venv" $usual discretisedfield==0.92.0 || wheels "$venv" $usual ||
    cannot "numpy, matplotlib and vtk cannot be installed: is there a network?"
wheels "$venv" PyGT==0.3.0 networkx==3.4.2 || wheels "$venv" networkx==3.4.2 || true
cargo build --release --quiet --manifest-path "$root/Cargo.toml"
export PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=Agg
"$venv/bin/python" "$here/check.py" "${CARGO_TARGET_DIR:-$root/target}/release/spinneb" "$root/docs/src/python.md"
