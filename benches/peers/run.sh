#!/bin/sh
# Compares spinneb with the Python package spirit: benches/peers/run.sh [--venv DIR] [--repeat N] [--markdown]
# Installs spirit and numpy into a virtual environment (a temporary one unless DIR is given) and builds spinneb.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
packages="spirit==2.2.0 numpy==2.2.6"
. "$here/../shared/campaign.sh"
"$python" "$here/compare.py" --spinneb "$spinneb" "$@"
