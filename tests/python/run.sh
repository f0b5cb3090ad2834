#!/bin/sh
# The Python package: tests/python/run.sh [--slow]
# Builds its wheel, checks and weighs it, installs it into a fresh virtual environment, and runs its tests and its notebooks there;
# with --slow also those that take minutes. Everything comes into a temporary folder, but for what is compiled, in python/target.
# Exit code 77: the check cannot run here, and why is said.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
most=5000000
cannot() {
    echo "python: NOT CHECKED: $*" >&2
    exit 77
}
slow="not slow"
[ "${1:-}" != "--slow" ] || slow="slow or not slow"
python=
for name in ${PYTHON:-} python3 python3.14 python3.13 python3.12 python3.11 python3.10; do
    if command -v "$name" >/dev/null && "$name" -c 'import sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null; then
        python=$name
        break
    fi
done
[ -n "$python" ] || cannot "there is no Python from 3.10 on"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$python" -m venv "$work/venv" >/dev/null 2>&1 || cannot "$python cannot make a virtual environment with pip"
bin=$work/venv/bin
pip() {
    "$bin/python" -m pip install --quiet --disable-pip-version-check --no-compile --only-binary :all: "$@"
}
pip "maturin==1.9.6" || pip "maturin<2" || cannot "maturin cannot be installed: is there a network?"
pip numpy matplotlib pandas xarray pytest mypy nbmake ipykernel || cannot "what the tests need cannot be installed"
unset VIRTUAL_ENV CONDA_PREFIX
(cd "$root/python" && "$bin/maturin" build --quiet --release --locked --interpreter "$bin/python" --out "$work/wheels")
wheel=$(ls "$work"/wheels/*.whl)
size=$(wc -c <"$wheel")
echo "python: $(basename "$wheel"), $size bytes"
[ "$size" -lt $most ] || { echo "python: the wheel is larger than $most bytes" >&2; exit 1; }
case $wheel in *-cp310-abi3-*) ;; *) echo "python: the wheel is not for every Python from 3.10 on" >&2; exit 1 ;; esac
pip --no-index --no-deps "$wheel"
export PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=Agg SPINNEB_BIN="$bin/spinneb"
"$bin/spinneb" --version
# outside of the sources: what is tested is what is installed
mkdir "$work/own"
cp -r "$root/python/tests" "$root/python/notebooks" "$root/python/generate.py" "$root/python/pyproject.toml" "$work/own"
cd "$work/own"
SPINNEB_CONFIGS="$root/configs" "$bin/python" -m pytest -q -p no:cacheprovider -m "$slow" tests
"$bin/python" -m pytest -q -p no:cacheprovider --nbmake notebooks
