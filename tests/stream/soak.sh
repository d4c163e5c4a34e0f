#!/bin/sh
# The long soak: renders scenes, plays a million frames of them to tapemark-stream while harm is done to it, and
# writes data/soak: soak.csv, soak.txt and, where a Python with matplotlib is (PYTHON names it), soak.png.
# Usage: sh tests/stream/soak.sh BUILD_FOLDER [FRAMES [OUTPUT_FOLDER]]
set -eu
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
frames=${2:-1000000}
output=${3:-$here/../../data/soak}
python=${PYTHON:-python3}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$output"
sh "$here/soak_scenes.sh" "$build" "$work"
status=0
"$build/tests/bin/stream_soak" "$build/bin/tapemark-stream" "$work/recordings" "$work/truth.jsonl" "$frames" \
    "$output/soak.csv" >"$output/soak.txt" || status=$?
cat "$output/soak.txt"
if "$python" -c 'import matplotlib' 2>/dev/null; then
    "$python" "$here/soak_plot.py" "$output/soak.csv" "$output/soak.png"
else
    echo "$0: no picture is drawn: $python has no matplotlib" >&2
fi
exit $status
