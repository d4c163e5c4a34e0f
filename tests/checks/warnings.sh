#!/bin/sh
# Usage: warnings.sh [COMPILER[@TARGET]:LEVEL...]
# Compiles the library, file by file, without a warning: by each compiler at each level that is named, or by all that
# the project knows at -O0 to -O3 and -Os. What compilers notice depends on how far they optimise, and for what: clang
# knows all targets.
set -eu
cd "$(dirname "$0")/../.."
if [ $# -eq 0 ]; then
    compilers=
    for target in aarch64-linux-gnu arm-linux-gnueabihf s390x-linux-gnu arm-none-eabi; do
        compilers="$compilers $target-gcc clang@$target"
    done
    for compiler in gcc clang $compilers; do
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
    *arm-none-*) own="-mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16 -ffreestanding" ;;
    esac
    case $compiler in
    clang@arm-none-*) # which has no headers beside its own
        own="$own -isystem $(dirname "$("${compiler#*@}-gcc" -print-file-name=libc.a)")/../include"
        ;;
    esac
    case $compiler in
    clang@*) own="--target=${compiler#*@} $own" compiler=clang ;;
    esac
    # shellcheck disable=SC2086 # words of $flags and $own are options
    if printf '%s\n' lib/src/*.c lib/link/src/*.c lib/link/sender/*.c |
        xargs -P "$(nproc)" -n 1 "$compiler" $flags $own "-${pair#*:}" -c -o /dev/null; then
        echo "$pair: no warnings"
    else
        status=1
    fi
done
exit $status
