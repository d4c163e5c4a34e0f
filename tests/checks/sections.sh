#!/bin/sh
# Usage: sections.sh OBJDUMP LIBRARY CODE_LIMIT_BYTES CONSTANTS_LIMIT_BYTES
# A static library has no memory that can be written to. (Constant tables of addresses are relocated when a
# program starts, and constant after that: .data.rel.ro.) Its code and constants stay within their limits.
set -eu

"$1" -h "$2" | awk -v code_limit="$3" -v constants_limit="$4" '
    function bytes_of(hex,    i, value) {
        for (i = 1; i <= length(hex); i++) value = value * 16 + index("0123456789abcdef", substr(hex, i, 1)) - 1
        return value
    }
    $1 ~ /^[0-9]+$/ && $2 ~ /^\./ { name = $2; size = bytes_of($3); next }
    /ALLOC/ {
        sections++
        if (size == 0) next
        if (/CODE/) code += size
        else if (/READONLY/ || name ~ /^\.data\.rel\.ro/) { if (name !~ /^\.(eh_frame|ARM)/) constants += size }
        else { print "writable " name " of " size " bytes"; failed = 1 }
    }
    END {
        if (!sections) { print "no sections in the library"; exit 1 }
        print "code " code " bytes, constants " constants + 0 " bytes"
        if (code > code_limit) { print code " bytes of code, limit " code_limit; failed = 1 }
        if (constants > constants_limit) {
            print constants " bytes of constants, limit " constants_limit
            failed = 1
        }
        exit failed
    }'
