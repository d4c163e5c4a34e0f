#!/bin/sh
# Usage: sh tests/fuzz/campaign.sh BUILD FOLDER MINUTES [TARGET...]
# Fuzzes each target (all, when none is named) for so many minutes, one after another, going on from what FOLDER holds
# from before, and prints a table of all runs there were. BUILD is a build of the preset fuzz.
#
# FOLDER/found/TARGET holds what made a target fail: shorten it with -minimize_crash=1, mend the fault, and keep it in
# tests/fuzz/regressions/TARGET. FOLDER/log has a line a run.
set -u

if [ $# -lt 3 ]; then
    sed -n '2s/^# //p' "$0" >&2
    exit 2
fi
build=$1
folder=$2
minutes=$3
shift 3
if [ $# -eq 0 ]; then
    # shellcheck disable=SC2046 # a word a target
    set -- $(cd "$build/tests/bin" && ls | sed -n 's/^fuzz_//p')
fi
here=$(dirname "$0")

# The last number after a word of what libFuzzer printed.
last_number()
{
    sed -n "s/.*$1 *\([0-9][0-9]*\).*/\1/p" "$2" | tail -n 1
}

# Out of what the shell tells of its children, in whole seconds: user and system.
processor_seconds()
{
    awk 'NR == 2 { gsub("[ms]", " "); print int($1 * 60 + $2 + $3 * 60 + $4) }' "$1"
}

fuzz()
(
    target=$1
    kept=$folder/inputs/$target
    found=$folder/found/$target
    output=$folder/output/$target
    mkdir -p "$kept" "$found" "$folder/output"
    set -- "$kept" "$folder/seeds/$target"
    [ ! -d "$here/regressions/$target" ] || set -- "$@" "$here/regressions/$target"
    words=$folder/seeds/words/$target.dict
    [ ! -f "$words" ] || set -- "$@" "-dict=$words"
    "$build/tests/bin/fuzz_$target" "$@" -max_total_time=$((minutes * 60)) -rss_limit_mb=1500 -timeout=30 \
        -artifact_prefix="$found/" -print_final_stats=1 >"$output" 2>&1
    end=$?
    times >"$output.times"
    echo "$(date +%FT%T) $target $(processor_seconds "$output.times")" \
        "$(last_number number_of_executed_units: "$output") $(last_number cov: "$output")" \
        "$(last_number ft: "$output") $end" >>"$folder/log"
)

report()
{
    printf '%-14s %14s %12s %8s %9s %7s %6s\n' target 'processor, s' inputs edges features kept found
    awk '{ seconds[$2] += $3; inputs[$2] += $4; edges[$2] = $5; features[$2] = $6 }
         END { for (t in seconds) print t, seconds[t], inputs[t], edges[t], features[t] }' "$folder/log" | sort |
        while read -r target seconds inputs edges features; do
            printf '%-14s %14s %12s %8s %9s %7s %6s\n' "$target" "$seconds" "$inputs" "$edges" "$features" \
                "$(find "$folder/inputs/$target" -type f | wc -l)" "$(find "$folder/found/$target" -type f | wc -l)"
        done
}

[ -d "$folder/seeds" ] || python3 "$here/seeds.py" "$here/../.." "$folder/seeds" || exit 1
for target in "$@"; do
    fuzz "$target"
done
report
