#!/bin/sh
# usage: check_data.sh DATA_DIRECTORY SCENE_RENDER...
#
# Runs the tapemark-render commands in the README of the data directory again, in a directory of their own, and
# compares: every file there is must come out as it is. Another compiler or C library may round a value the other
# way, so one byte in a thousand may differ.
set -eu

data=$(cd "$1" && pwd)
shift

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/data"
cd "$work"

# A command goes on in the next line after a backslash; read joins them.
commands=0
while read -r line || [ -n "$line" ]; do
    case $line in
    *tapemark-render*.raw | *tapemark-render*.y4m | *tapemark-render*.pgm | *tapemark-render*.png) ;;
    *) continue ;;
    esac
    # Neither quotes nor patterns are used in the commands: plain splitting takes them apart.
    # shellcheck disable=SC2086
    "$@" ${line#*tapemark-render }
    commands=$((commands + 1))
done <<COMMANDS
$(sed -e ':join' -e '/\\$/{N' -e 's/\\\n */ /' -e 'b join' -e '}' "$data/README.md")
COMMANDS
if [ "$commands" -eq 0 ]; then
    echo "README.md: found no tapemark-render commands" >&2
    exit 1
fi

failures=0
complain()
{
    echo "$1" >&2
    failures=$((failures + 1))
}

for made in data/*; do
    [ -f "$data/${made#data/}" ] || complain "$made: made by a command, but not there"
done
for kept in "$data"/*; do
    name=${kept##*/}
    case $name in
    README.md | *.png) continue ;; # for people to look at
    esac
    if [ ! -f "data/$name" ]; then
        complain "data/$name: no command in README.md makes it"
        continue
    fi
    size=$(wc -c <"$kept")
    if [ "$size" -ne "$(wc -c <"data/$name")" ]; then
        complain "data/$name: is $size bytes, comes out as $(wc -c <"data/$name")"
        continue
    fi
    different=$(cmp -l "$kept" "data/$name" | wc -l)
    [ $((different * 1000)) -le "$size" ] || complain "data/$name: $different of $size bytes come out differently"
done
[ "$failures" -eq 0 ]
