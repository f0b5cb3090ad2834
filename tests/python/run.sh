#!/bin/sh
# The Python package: tests/python/run.sh [--slow]
# Builds its wheel, installs it into a fresh virtual environment, and runs its tests and its notebooks there; with --slow also those
# that take minutes, with a wheel as it is shipped, which is weighed. Everything comes into a temporary folder, but for what is compiled.
# Exit code 77: the check cannot run here, and why is said.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
cannot() {
    echo "python: NOT CHECKED: $*" >&2
    exit 77
}
slow="not slow"
[ "${1:-}" != "--slow" ] || slow="slow or not slow"
. "$here/../venv.sh"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
venv "$work/venv"
bin=$work/venv/bin
wheels "$work/venv" "maturin==1.9.6" || wheels "$work/venv" "maturin<2" || cannot "maturin cannot be installed: is there a network?"
wheels "$work/venv" numpy matplotlib pandas xarray pytest mypy nbmake ipykernel || cannot "what the tests need cannot be installed"
# a system may have no wheels of it: its test says that it was skipped
wheels "$work/venv" pyvista || true
unset VIRTUAL_ENV CONDA_PREFIX
if [ "$slow" = "not slow" ]; then
    # as the program is compiled, and with what was compiled for it: half the work of a wheel that is small
    set -- --release --target-dir "${CARGO_TARGET_DIR:-$root/target}"
    most=
else
    # linked by zig, as tools/release.sh makes it
    set -- --profile wheel
    if [ "$(uname -s)" = Linux ] && wheels "$work/venv" ziglang; then
        set -- "$@" --zig --compatibility manylinux2014
        PATH=$bin:$PATH
    fi
    most=5000000
fi
(cd "$root/python" && "$bin/maturin" build --quiet --locked --interpreter "$bin/python" --out "$work/wheels" "$@")
wheel=$(ls "$work"/wheels/*.whl)
size=$(wc -c <"$wheel")
echo "python: $(basename "$wheel"), $size bytes"
[ -z "$most" ] || [ "$size" -lt "$most" ] || { echo "python: the wheel is larger than $most bytes" >&2; exit 1; }
case $wheel in *-cp310-abi3-*) ;; *) echo "python: the wheel is not for every Python from 3.10 on" >&2; exit 1 ;; esac
wheels "$work/venv" --no-index --no-deps "$wheel"
# as pip leaves it for its users
"$bin/python" -m compileall -q "$work"/venv/lib*/python3*/site-packages/spinneb
export PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=Agg SPINNEB_BIN="$bin/spinneb"
"$bin/spinneb" --version
# outside of the sources: what is tested is what is installed
mkdir "$work/own"
cp -r "$root/python/tests" "$root/python/notebooks" "$root/python/generate.py" "$root/python/pyproject.toml" "$work/own"
cd "$work/own"
SPINNEB_CONFIGS="$root/configs" "$bin/python" -m pytest -q -rs -p no:cacheprovider -m "$slow" tests
"$bin/python" -m pytest -q -p no:cacheprovider --nbmake notebooks
