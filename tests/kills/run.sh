#!/usr/bin/env bash
# Kills runs at random moments, COUNT times (1000 if not given), and lets each go on until its end, which must be that of a run
# that nobody disturbed, to the last bit. A second number is the seed. Needs the Rust toolchain and a shell.
set -euo pipefail
cd "$(dirname "$0")/../.."
cargo bench --bench kills -- "${@:-1000}"
