#!/bin/sh
# Usage: symbols.sh NM LIBRARY ALLOWED...
# A static library needs no symbols but its own and the allowed ones, and defines none that could collide with
# its user's.
set -eu
nm=$1
library=$2
shift 2

"$nm" -P "$library" | awk -v allowed="$*" '
    BEGIN { count = split(allowed, names, " "); for (i = 1; i <= count; i++) is_allowed[names[i]] = 1 }
    NF < 2 { next }
    $2 ~ /^[Uwv]$/ { needed[$1] = 1; next }
    { defined[$1] = 1; symbols++ }
    $2 ~ /^[A-Z]$/ && $1 !~ /^(tapemark|tmi)_/ { print "defines " $1 ", which has none of its prefixes"; failed = 1 }
    END {
        if (!symbols) { print "no symbols in the library"; exit 1 }
        for (name in needed) {
            if (name in defined) continue
            if (name in is_allowed) print "needs " name ", as it may"
            else { print "needs " name ", which is not allowed"; failed = 1 }
        }
        exit failed
    }'
