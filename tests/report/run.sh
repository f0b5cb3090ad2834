#!/bin/sh
# report.html in a headless Chromium: tests/report/run.sh [FOLDER FOR PICTURES]
# Uses $CHROMIUM, or chromium or Chrome where it is installed, or installs Debian's chromium; beyond that Python's own library alone.
# Exit code 77: the check cannot run here, and why is said.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
cannot() {
    echo "report: NOT CHECKED: $*" >&2
    exit 77
}
command -v python3 >/dev/null || cannot "there is no python3"
browser() {
    for name in "${CHROMIUM:-}" chromium chromium-browser google-chrome; do
        [ -n "$name" ] && command -v "$name" && return
    done
    return 1
}
if ! chromium=$(browser); then
    as_root=
    [ "$(id -u)" = 0 ] || as_root="sudo -n"
    command -v apt-get >/dev/null || cannot "there is no Chromium, and no apt-get to install it"
    { $as_root apt-get update -qq && $as_root apt-get install -qq -y --no-install-recommends chromium; } >/dev/null 2>&1 ||
        cannot "there is no Chromium, and apt-get cannot install it"
    chromium=$(browser) || cannot "apt-get has installed no Chromium"
fi
cargo build --release --quiet --manifest-path "$root/Cargo.toml"
[ $# -eq 0 ] || mkdir -p "$1"
python3 "$here/check.py" "$chromium" "${CARGO_TARGET_DIR:-$root/target}/release/spinneb" "$root/configs" "$@"
