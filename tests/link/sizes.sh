#!/bin/sh
# Usage: sizes.sh PROCESSOR LINK_FOLDER CC SIZE FLAG...
# What the receiver adds to a program for a microcontroller, with all that it pulls in from the compiler's libraries:
# flash, memory, and the stack were all its functions to call each other. Held against limits a little above what the
# page of the format says.
set -eu
processor=$1
link=$2
compiler=$3
size=$4
shift 4

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cat >"$work/with.c" <<'END'
#include "tapemark_receiver.h"

volatile uint8_t port;
static tapemark_receiver receiver;

int main(void)
{
    for (;;)
        if (tapemark_receiver_push(&receiver, port) != TAPEMARK_RECORD_NONE)
            port = receiver.record.as.cm.index;
}
END
cat >"$work/without.c" <<'END'
#include <stdint.h>

volatile uint8_t port;

int main(void)
{
    for (;;)
        port = port;
}
END

# Flash and memory of a program, in bytes.
weigh()
{
    "$size" "$1" | awk 'NR == 2 { print $1 + $2, $2 + $3 }'
}

# Frames of the functions that take part in receiving, and a return address for each.
stack_bytes()
{
    awk -F '\t' '$1 !~ /:(tapemark_command_write|write_[a-z]*|tapemark_receiver_reset)$/ { sum += $2 + 4 }
        END { print sum }' "$1"
}

status=0
check()
{
    name=$1
    flash_limit=$2
    memory_limit=$3
    shift 3
    "$compiler" -std=c99 -pedantic-errors -Wall -Wextra -Wconversion -Wshadow -Werror "-I$link/src" \
        -Os -ffunction-sections -fdata-sections -fstack-usage "$@" -c "$link/src/tapemark_receiver.c" \
        -o "$work/receiver.o"
    # Without hardware for it, floating point shows in the names of the compiler's helpers.
    if "${size%size}nm" -u "$work/receiver.o" | grep -E '[a-z][sd]f[0-9]?$|__aeabi_[fd]|alloc'; then
        echo "$name: that is floating point or heap"
        status=1
    fi
    "$compiler" -std=c99 -Os "-I$link/src" "$@" -Wl,--gc-sections "$work/with.c" "$work/receiver.o" -o "$work/with"
    "$compiler" -std=c99 -Os "$@" -Wl,--gc-sections "$work/without.c" -o "$work/without"
    # shellcheck disable=SC2046 # two numbers each
    set -- $(weigh "$work/with") $(weigh "$work/without")
    flash=$(($1 - $3))
    memory=$(($2 - $4))
    stack=$(stack_bytes "$work/receiver.su")
    echo "receiver, $processor, $name: flash $flash bytes, memory $memory bytes, stack below $stack bytes"
    if [ "$flash" -gt "$flash_limit" ] || [ "$memory" -gt "$memory_limit" ] || [ "$flash" -lt 500 ]; then
        echo "$name: expected at most $flash_limit bytes of flash and $memory_limit of memory"
        status=1
    fi
}

check "packets alone" 1280 136 -DTAPEMARK_RECEIVER_NO_SENTENCES "$@"
check "sentences alone" 1920 168 -DTAPEMARK_RECEIVER_NO_PACKETS "$@"
check "both" 2560 232 "$@"
exit $status
