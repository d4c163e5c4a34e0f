#!/bin/sh
# Usage: second_opinion.sh PYTHON LINK_FOLDER WRITE_RECORDS
# The page, the vectors and what the sender writes, as reference.py sees them, which knows the page alone.
set -eu
python=$1
link=$2
write_records=$3
reference=$(dirname "$0")/reference.py

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$python" "$reference" page "$link/README.md"
"$python" "$reference" vectors "$link/README.md" "$link/vectors.txt"

"$write_records" 1 8000 "$work/stream" "$work/sent"
"$python" "$reference" decode "$link/README.md" <"$work/stream" >"$work/read"
[ "$(wc -l <"$work/read")" -eq 8000 ]
cmp "$work/sent" "$work/read"
