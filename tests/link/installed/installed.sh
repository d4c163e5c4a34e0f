#!/bin/sh
# Usage: installed.sh CMAKE GENERATOR CC BUILD_DIR PROJECT_VERSION ARDUINO_CORE
# Installs into an empty place, and uses the link from there: through the CMake package, through pkg-config's
# folders, and as an Arduino library, whose own description is held against what the IDE asks of it.
set -eu
here=$(dirname "$0")
cmake=$1
generator=$2
cc=$3
build=$4
version=$5
core=$6

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
"$cmake" --install "$build" --prefix "$place/installed" >"$place/install.log"
prefix=$place/moved
mv "$place/installed" "$prefix"

"$cmake" -G "$generator" -S "$here" -B "$place/build" -DCMAKE_C_COMPILER="$cc" -DCMAKE_PREFIX_PATH="$prefix" \
    >"$place/configure.log"
"$cmake" --build "$place/build" >"$place/build.log" || {
    cat "$place/build.log"
    exit 1
}
"$place/build/both_ends"

PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name tapemark.pc)")
export PKG_CONFIG_PATH
# Options come from pkg-config as words.
# shellcheck disable=SC2046
"$cc" -Wall -Wextra -Werror $(pkg-config --cflags tapemark) "$here/both_ends.c" -o "$place/by-pkg-config" \
    $(pkg-config --libs tapemark) -ltapemark_sender -ltapemark_receiver
LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH") "$place/by-pkg-config"

library=$prefix/share/tapemark/arduino/Tapemark
# Without one of these, the IDE does not take the folder for a library, and does not say so.
for property in name version author maintainer sentence paragraph category url architectures; do
    if ! grep -q "^$property=." "$library/library.properties"; then
        echo "library.properties: no $property"
        exit 1
    fi
done
grep -qx "version=$version" "$library/library.properties" || {
    echo "library.properties: expected version=$version"
    exit 1
}
# A word and its kind with one tab between them; each word stands in the header.
while IFS='	' read -r word kind rest; do
    if [ -z "$kind" ] || [ -n "$rest" ] || ! grep -qw "$word" "$library/src/tapemark_receiver.h"; then
        echo "keywords.txt: $word $kind $rest"
        exit 1
    fi
done <"$library/keywords.txt"
# The links of its page lead to what is there.
sed -n 's/.*](\([^)#]*\)).*/\1/p' "$library/README.md" | while read -r target; do
    [ -e "$library/$target" ] || {
        echo "README.md: no $target"
        exit 1
    }
done
[ -s "$library/LICENSE" ]

mkdir "$place/sketch"
sh "$here/../board/build_sketch.sh" "$library" "$core" "$place/sketch"
ls "$place/sketch"
