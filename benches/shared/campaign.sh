# Read in by the scripts of campaigns in Python: takes `--venv DIR` from the arguments, makes the virtual environment (a temporary one
# unless DIR is given) with $packages, and builds spinneb. Leaves $python and $spinneb.
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
python=$venv/bin/python
[ -x "$python" ] || python3 -m venv "$venv"
"$python" -m pip install --quiet --disable-pip-version-check $packages
cargo build --profile dist --quiet --manifest-path "$root/Cargo.toml"
spinneb=${CARGO_TARGET_DIR:-$root/target}/dist/spinneb
export PYTHONDONTWRITEBYTECODE=1
