#!/bin/sh
# usage: check_data.sh DATA_DIRECTORY tapemark-render tapemark-make picture_pixels
#
# Runs the tapemark-render and tapemark-make commands in the README of the data directory again, in a directory of
# their own, and compares: every file there is must come out as it is, pictures pixel by pixel. Another compiler or C
# library may round a value the other way, so one byte in a thousand may differ; and of the plan's picture, letters in
# other fonts: one in twenty.
set -eu

data=$(cd "$1" && pwd)
render=$2
make=$3
pixels=$4

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/data"
cp "$data"/*.csv "$data/plan.json" "$work/data"
cd "$work"

failures=0
complain()
{
    echo "$1" >&2
    failures=$((failures + 1))
}

# A command goes on in the next line after a backslash. Neither quotes nor patterns are used in the commands: plain
# splitting takes them apart.
commands=0
while read -r program words || [ -n "$program" ]; do
    case $program in
    */tapemark-render) program=$render ;;
    */tapemark-make) program=$make ;;
    *) continue ;;
    esac
    case $words in
    *' && '*) after=${words#* && } words=${words%% && *} ;;
    *) after=: ;;
    esac
    # shellcheck disable=SC2086
    "$program" $words >/dev/null && $after || complain "$words: fails"
    commands=$((commands + 1))
done <<COMMANDS
$(sed -e ':join' -e '/\\$/{N' -e 's/\\\n */ /' -e 'b join' -e '}' "$data/README.md")
COMMANDS
[ "$commands" -gt 0 ] || complain 'README.md: found no commands'

# as_bytes FILE: what of it has to be the same.
as_bytes()
{
    case $1 in
    *.png) "$pixels" "$1" ;;
    *) cat "$1" ;;
    esac
}

for made in data/*; do
    [ -f "$data/${made#data/}" ] || complain "$made: made by a command, but not there"
done
for kept in "$data"/*; do
    name=${kept##*/}
    case $name in
    README.md) continue ;;
    # What was measured, with a page of its own that names its command.
    evaluation | lies | soak) continue ;;
    esac
    if [ ! -f "data/$name" ]; then
        # Pictures that other programs drew for people to look at.
        [ "${name%.png}" != "$name" ] || complain "data/$name: no command in README.md makes it"
        continue
    fi
    as_bytes "$kept" >kept.bytes
    as_bytes "data/$name" >made.bytes
    size=$(wc -c <kept.bytes)
    if [ "$size" -ne "$(wc -c <made.bytes)" ]; then
        complain "data/$name: is $size bytes, comes out as $(wc -c <made.bytes)"
        continue
    fi
    different=$(cmp -l kept.bytes made.bytes | wc -l)
    case $name in
    plan-preview.png) one_in=20 ;;
    *) one_in=1000 ;;
    esac
    [ $((different * one_in)) -le "$size" ] || complain "data/$name: $different of $size bytes come out differently"
done
[ "$failures" -eq 0 ]
