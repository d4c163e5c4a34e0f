#!/bin/sh
# Instructions that tapemark_decode takes for a frame of the tape video, counted by callgrind, and the functions
# that take most of them. The count hardly changes from run to run, however busy the machine is.
#
# usage: instructions.sh TAPEMARK-BENCH [FRAMES]     FRAMES as for tapemark-bench --frames; default 0..99
set -eu

if [ $# -lt 1 ] || [ $# -gt 2 ]; then
    echo "usage: instructions.sh TAPEMARK-BENCH [FRAMES]" >&2
    exit 2
fi
bench=$1
frames=${2:-0..99}
if ! command -v valgrind >/dev/null; then
    echo "instructions.sh: needs valgrind, and it is not installed" >&2
    exit 77
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM

if ! valgrind --tool=callgrind --toggle-collect=tapemark_decode --callgrind-out-file="$work/profile" \
    "$bench" --only tapemark --sources tape --frames "$frames" --repeat 0 --json "$work/run.json" \
    >"$work/out" 2>"$work/err"; then
    grep -v '^==' "$work/err" >&2 || cat "$work/err" >&2
    exit 1
fi

instructions=$(awk '/^(totals|summary):/ { print $2; exit }' "$work/profile")
count=$(awk -F: '/"frames":/ { print $2 + 0; exit }' "$work/run.json")
if [ "${instructions:-0}" -eq 0 ]; then
    echo "instructions.sh: callgrind saw no call of tapemark_decode in $bench" >&2
    exit 1
fi
echo "$((instructions / count)) instructions a frame (mean of $count frames)"
echo
echo "of all instructions, by function:"
callgrind_annotate --threshold=99 "$work/profile" |
    sed -n 's/^ *\([0-9,]*\) *(\( *[0-9.]*%\)) *\([^ ]*:\)\{0,1\}\([^ ]*\).*/\2  \4/p' | grep -v PROGRAM | head -15
