#!/bin/sh
# Usage: rejects.sh COMPLAINT COMMAND...
# Succeeds when the command fails and its output has the complaint in it.
set -u
complaint=$1
shift
if output=$("$@" 2>&1); then
    echo "not rejected; expected: $complaint"
    exit 1
fi
printf '%s\n' "$output"
printf '%s\n' "$output" | grep -qF -e "$complaint"
