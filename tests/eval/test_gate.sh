#!/bin/sh
# Usage: test_gate.sh MODULES LIBRARY SCENES REPORT
# The short evaluation: nothing has fallen since the counts in REPORT were taken; and that a worse picture, a wrong
# report and a missing one are noticed.
set -u
modules=$1 library=$2 scenes=$3 report=$4
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

fail()
{
    echo "FAILED: $*" >&2
    [ ! -s "$work/out" ] || cat "$work/out" >&2
    exit 1
}

gate()
{
    PYTHONPATH=$modules PYTHONDONTWRITEBYTECODE=1 python3 -m tapemark_eval.gate --library "$library" \
        --scenes "$scenes" "$@" >"$work/out" 2>&1
}

gate --report "$report" || fail "the decoder has fallen below its own numbers"
cat "$work/out"

# Noise in the pictures, and a baseline that has one wrong reading less everywhere.
python3 - "$report" >"$work/better.json" <<'EOF' || fail "no better report"
import json, sys
report = json.load(open(sys.argv[1]))
for step in report["gate"]:
    step["wrong"] -= 1
json.dump(report, sys.stdout)
EOF
gate --report "$work/better.json" --with "--noise 14" && fail "neither noise nor wrong readings were noticed"
grep -q "^fallen: distance .* code markers read" "$work/out" || fail "noise: no step of the distance has fallen"
grep -q "^fallen: all steps: .* code markers read" "$work/out" || fail "noise: not all steps together have fallen"
grep -q "^fallen: .* wrong readings" "$work/out" || fail "no line about wrong readings"

echo '{"gate": []}' >"$work/none.json"
gate --report "$work/none.json" && fail "a report of other steps was accepted"
grep -q "counts of other steps" "$work/out" || fail "a report of other steps: not said so"
gate --report "$work/absent.json" && fail "an absent report was accepted"
[ "$(wc -l <"$work/out")" -eq 1 ] || fail "an absent report: not one line"
echo '{"gate": 7}' >"$work/none.json"
gate --report "$work/none.json" && fail "a report of something else was accepted"
grep -q "holds no counts" "$work/out" || fail "a report of something else: not said so"
