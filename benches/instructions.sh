#!/bin/sh
# Instructions that a run without a search for a lower pass takes, counted by valgrind: the same on a busy machine as on a quiet one.
#
#   benches/instructions.sh            compares with benches/instructions.txt; fails where a count has grown by more than 5 %
#   benches/instructions.sh --record   writes the counts there
#
# Needs valgrind. Counts depend on the compiler, so the file names the one it was recorded with.
set -eu
cd "$(dirname "$0")/.."
record=benches/instructions.txt
command -v valgrind >/dev/null || { echo "valgrind is not installed (Debian: apt-get install valgrind)" >&2; exit 2; }
cargo build --release --quiet
binary="${CARGO_TARGET_DIR:-target}/release/spinneb"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

count() {
    # exit code 3 says "not certified", which is no failure of the count
    valgrind --tool=cachegrind --cache-sim=no --cachegrind-out-file=/dev/null \
        "$binary" run "configs/$1.json" --effort none --threads 1 --quiet --set 'output.plots=[]' --out "$work/$1" >"$work/summary" 2>"$work/log" ||
        [ $? -eq 3 ] || { cat "$work/log" >&2; exit 1; }
    sed -n 's/.*I *refs: *//p' "$work/log" | tr -d ,
}

if [ "${1:-}" = --record ]; then
    echo "# instructions of a run without plots on one thread; $(rustc --version)" >"$record"
    for name in wall_nucleation wall_depinning dmi_chain ring_nucleus; do
        echo "$name $(count "$name")" | tee -a "$record"
    done
    exit
fi
grown=0
while read -r name before; do
    case $name in \#*) continue ;; esac
    now=$(count "$name")
    echo "$name $before -> $now, $((1000 * now / before)) per mille"
    [ "$((100 * now))" -le "$((105 * before))" ] || grown=1
done <"$record"
[ "$grown" -eq 0 ] || { echo "more instructions than recorded: slower, or a change to be recorded" >&2; exit 1; }
