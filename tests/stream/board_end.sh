#!/bin/sh
# Usage: board_end.sh PYTHON LINK_FOLDER ARDUINO_CORE AVR_BOARD PROGRAM WALK.y4m
# Builds the Arduino example and puts it at the end of the program's serial line.
set -eu
here=$(dirname "$0")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sh "$here/../link/board/build_sketch.sh" "$2" "$3" "$work"
"$1" "$here/board_end.py" "$4" "$work/both.elf" "$2/README.md" "$5" "$6"
