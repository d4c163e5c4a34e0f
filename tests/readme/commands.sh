#!/bin/sh
# Usage: commands.sh README BIN_DIR
# The marked commands succeed, one by one, in a copy of what they may read, and print something.
set -eu
readme=$1
bin=$2

place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
awk -v mark='<!-- tested: commands -->' -f "$(dirname "$0")/fence.awk" "$readme" |
    sed -e '/^ *#/d' -e '/^ *$/d' >"$place/commands"
if [ ! -s "$place/commands" ]; then
    echo "$readme: no block marked <!-- tested: commands -->"
    exit 1
fi

mkdir -p "$place/source/build/release"
ln -s "$bin" "$place/source/build/release/bin"
cp -R "$(dirname "$readme")/data" "$place/source/data"
cd "$place/source"
while read -r command; do
    echo "$command"
    sh -c "$command" </dev/null >"$place/output"
    [ -s "$place/output" ] || { echo "printed nothing"; exit 1; }
done <"$place/commands"
