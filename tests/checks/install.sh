#!/bin/sh
# Usage: install.sh CMAKE GENERATOR CC BUILD_DIR CONSUMER_DIR
# Installs the library into an empty place, moves it, and builds the same small program against it in each way
# that a user may choose.
set -eu
cmake=$1
generator=$2
cc=$3
build=$4
consumer=$5

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
"$cmake" --install "$build" --prefix "$place/installed" >"$place/install.log"
unit=$(find "$place/installed" -name tapemark-stream.service)
[ -z "$unit" ] || grep -q "^ExecStart=$place/installed/bin/tapemark-stream " "$unit"
prefix=$place/moved
mv "$place/installed" "$prefix"

pc=$(find "$prefix" -name tapemark.pc)
libdir=$(dirname "$(dirname "$pc")")
PKG_CONFIG_PATH=$(dirname "$pc")
export PKG_CONFIG_PATH
version=$(pkg-config --modversion tapemark)

# Options come from pkg-config as words.
# shellcheck disable=SC2046
"$cc" -Wall -Wextra -Werror $(pkg-config --cflags tapemark) "$consumer/consumer.c" -o "$place/by-pkg-config" \
    $(pkg-config --libs tapemark)
LD_LIBRARY_PATH=$libdir "$place/by-pkg-config" "$version"
readelf -d "$place/by-pkg-config" | grep -q 'NEEDED.*\[libtapemark\.so\.[0-9]*\]'

"$cmake" -G "$generator" -S "$consumer" -B "$place/build" -DCMAKE_C_COMPILER="$cc" -DCMAKE_PREFIX_PATH="$prefix" \
    -DEXPECTED_VERSION="$version" >"$place/configure.log"
"$cmake" --build "$place/build" >"$place/build.log" || {
    cat "$place/build.log"
    exit 1
}
"$place/build/with_static" "$version"
"$place/build/with_shared" "$version"
