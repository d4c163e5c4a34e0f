#!/bin/sh
# Usage: warnings.sh [COMPILER:LEVEL...]
# Compiles the library, file by file, without a warning: by each compiler at each level that is named, or by all that
# the project knows at -O0 to -O3 and -Os. What compilers notice depends on how far they optimise.
set -eu
cd "$(dirname "$0")/../.."
if [ $# -eq 0 ]; then
    for compiler in gcc clang aarch64-linux-gnu-gcc arm-linux-gnueabihf-gcc s390x-linux-gnu-gcc arm-none-eabi-gcc; do
        for level in O0 O1 O2 O3 Os; do
            set -- "$@" "$compiler:$level"
        done
    done
fi

flags="-std=c11 -Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wdouble-promotion -Wvla -Wmissing-prototypes -Werror
    -fno-math-errno -fno-trapping-math -Ilib/include -Ilib/src -Ilib/link/src -Ilib/link/sender"
status=0
for pair in "$@"; do
    compiler=${pair%:*}
    own=
    case $compiler in
    s390x-*) own=-fexcess-precision=fast ;; # as in lib/cmake
    arm-none-*) own="-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -ffreestanding" ;;
    esac
    # shellcheck disable=SC2086 # words of $flags and $own are options
    if printf '%s\n' lib/src/*.c lib/link/src/*.c lib/link/sender/*.c |
        xargs -P "$(nproc)" -n 1 "$compiler" $flags $own "-${pair#*:}" -c -o /dev/null; then
        echo "$compiler -${pair#*:}: no warnings"
    else
        status=1
    fi
done
exit $status
