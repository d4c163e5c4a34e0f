#!/bin/sh
# Usage: exports.sh CC NM HEADER SHARED_LIBRARY
# The shared library exports the functions that the public header declares, and nothing else.
set -eu

declared=$("$1" -E -P "$3" | grep -o '\btapemark_[a-z0-9_]*(' | tr -d '(' | sort)
exported=$("$2" -D -P --defined-only "$4" | awk '{ print $1 }' | sort)
if [ -z "$declared" ] || [ "$declared" != "$exported" ]; then
    printf 'declared:\n%s\nexported:\n%s\n' "$declared" "$exported"
    exit 1
fi
