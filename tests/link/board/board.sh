#!/bin/sh
# Usage: board.sh PYTHON LINK_FOLDER ARDUINO_CORE AVR_BOARD
# Builds the Arduino example, in the way of an Arduino library and with each encoding alone, and watches it at work.
set -eu
here=$(dirname "$0")
python=$1
link=$2
core=$3
avr_board=$4

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

lines=$(wc -l <"$link/examples/PrintMarkers/PrintMarkers.ino")
if [ "$lines" -gt 60 ]; then
    echo "the example has $lines lines; 60 are enough for anyone to read"
    exit 1
fi

sh "$here/build_sketch.sh" "$link" "$core" "$work"
"$python" "$here/watch_board.py" "$avr_board" "$work/both.elf" "$link/README.md" "$link/vectors.txt"
