#!/bin/sh
# Runs the benchmark on every tenth frame and fails when a limit is missed. Skipped without the videos, unless
# TAPEMARK_REQUIRE_PAPER_DATA is 1.
#
# usage: smoke.sh TAPEMARK-BENCH DEFAULT-DATA-DIR
set -eu

bench=$1
data=${TAPEMARK_PAPER_DATA:-$2}
if [ ! -f "$data/condition_a/tape.mp4" ] && [ "${TAPEMARK_REQUIRE_PAPER_DATA:-0}" != 1 ]; then
    echo "SKIPPED: no $data/condition_a/tape.mp4; TAPEMARK_PAPER_DATA names the folder with the paper's data"
    exit 77
fi
exec "$bench" --data "$data" --only tapemark,aruco --frames 0..99:10 --repeat 3 --clock cpu --check
