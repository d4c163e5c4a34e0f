#!/bin/sh
# Usage: sh tests/stream/latency.sh [BUILD [FRAMES]]
# The report of README.md of tapemark-stream: frames of 1280 x 720 px at 30 a second, through each way out.
set -eu
build=${1:-build/release}
frames=${2:-600}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$build/bin/tapemark-render" --scene walk --size 1280x720 --frames 48 --noise 0.6 --shot-noise 1.2 "$work/walk.y4m"
"$build/tests/bin/stream_latency" "$build/bin/tapemark-stream" "$work/walk.y4m" "$frames"
