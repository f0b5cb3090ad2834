#!/bin/sh
# Landscapes of random chains against an enumeration: benches/landscapes/run.sh [--venv DIR] [--first K] [--chains N]
# Installs numpy, scipy and networkx into a virtual environment (a temporary one unless DIR is given) and builds spinneb.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
packages="numpy==2.2.6 scipy==1.17.1 networkx==3.4.2"
. "$here/../shared/campaign.sh"
"$python" "$here/campaign.py" "$spinneb" "$@"
