#!/bin/sh
# Usage: program.sh README CC INCLUDE_DIR STATIC_LIBRARY [CFLAG...]
# The marked C program compiles without a warning, and prints what the README says.
set -eu
readme=$1
cc=$2
include_dir=$3
library=$4
shift 4

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
fences=$(dirname "$0")/fence.awk
awk -v mark='<!-- tested: program -->' -f "$fences" "$readme" >"$place/program.c"
awk -v mark='<!-- tested: output -->' -f "$fences" "$readme" >"$place/expected"
if [ ! -s "$place/program.c" ] || [ ! -s "$place/expected" ]; then
    echo "$readme: no block marked <!-- tested: program -->, or none marked <!-- tested: output -->"
    exit 1
fi

"$cc" "$@" -std=c11 -Wall -Wextra -Wpedantic -Werror -I"$include_dir" -o "$place/program" "$place/program.c" \
    "$library" -lm
cd "$(dirname "$readme")"
"$place/program" >"$place/printed"
diff "$place/expected" "$place/printed"
