#!/bin/sh
# Equivalent forms of random films: benches/forms/run.sh [--venv DIR] [--first K] [--films N] [--effort EFFORT]
# Installs numpy into a virtual environment (a temporary one unless DIR is given) and builds spinneb.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
packages="numpy==2.2.6"
. "$here/../shared/campaign.sh"
"$python" "$here/campaign.py" "$spinneb" "$@"
