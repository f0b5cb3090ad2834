#!/bin/sh
# Equivalent forms of random films: benches/forms/run.sh [--venv DIR] [--first K] [--films N] [--effort EFFORT]
# Installs numpy into a virtual environment (a temporary one unless DIR is given) and builds spinneb.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
venv=
if [ "${1:-}" = "--venv" ]; then
    [ $# -ge 2 ] || { echo "run.sh: --venv needs a folder" >&2; exit 2; }
    venv=$2
    shift 2
fi
if [ -z "$venv" ]; then
    venv=$(mktemp -d)
    trap 'rm -rf "$venv"' EXIT
fi
[ -x "$venv/bin/python" ] || python3 -m venv "$venv"
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check numpy==2.2.6
cargo build --release --quiet --manifest-path "$root/Cargo.toml"
export PYTHONDONTWRITEBYTECODE=1
"$venv/bin/python" "$here/campaign.py" "${CARGO_TARGET_DIR:-$root/target}/release/spinneb" "$@"
