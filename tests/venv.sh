# Virtual environments of Python for the scripts of the folders beside it, which read it in. They define `cannot`, which tells why a
# check cannot run here.

# Makes a virtual environment in a folder, unless there is one: venv FOLDER. Takes $PYTHON, or the first Python from 3.10 on.
venv() {
    [ ! -x "$1/bin/python" ] || return 0
    python=
    for name in ${PYTHON:-} python3 python3.14 python3.13 python3.12 python3.11 python3.10; do
        if command -v "$name" >/dev/null && "$name" -c 'import sys; sys.exit(sys.version_info < (3, 10))' 2>/dev/null; then
            python=$name
            break
        fi
    done
    [ -n "$python" ] || { cannot "there is no Python from 3.10 on"; return 1; }
    ! "$python" -m venv "$1" >/dev/null 2>&1 || return 0
    # Debian's python3 has the module in a package of its own
    { [ "$(id -u)" = 0 ] && apt-get update -qq && apt-get install -qq -y --no-install-recommends python3-venv; } >/dev/null 2>&1 || true
    "$python" -m venv "$1" >/dev/null 2>&1 || { cannot "$python cannot make a virtual environment with pip"; return 1; }
}

# Installs packages into it that are there as wheels: wheels FOLDER PACKAGE…
wheels() {
    folder=$1
    shift
    "$folder/bin/python" -m pip install --quiet --disable-pip-version-check --no-compile --only-binary :all: "$@"
}
