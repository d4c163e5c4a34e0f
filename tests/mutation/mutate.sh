#!/bin/sh
# Usage: mutate.sh [PATTERN]
# Breaks the library one line after the other, as mutations.txt tells (with a pattern, only where the file's name or
# the line matches it), and runs the tests until one fails. Prints for each what noticed it. Fails when none did, or
# when a line is no longer there. Takes a copy of the source tree, and some ten minutes.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
pattern=${1:-.}
source=$(cd "$here/../.." && pwd)
: "${TAPEMARK_PAPER_DATA:=$source/../shared/paper}"
export TAPEMARK_PAPER_DATA

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
trap 'exit 1' HUP INT TERM
copy=$work/source
build=$work/build
mkdir "$copy" "$copy/apps"
cp -R "$source/CMakeLists.txt" "$source/lib" "$source/tests" "$copy"
cp -R "$source/apps/render" "$copy/apps"
cp -R "$copy/lib" "$work"

cmake -G Ninja -S "$copy" -B "$build" -DCMAKE_BUILD_TYPE=RelWithDebInfo -DTAPEMARK_BUILD_PROGRAMS=OFF \
    -DCMAKE_COMPILE_WARNING_AS_ERROR=OFF \
    -DCMAKE_C_FLAGS="-fsanitize=alignment,bounds -fno-sanitize-recover=all" >"$work/log"
parts="tests/unit/all tests/link/all tests/decode/all tests/lies/all"
# shellcheck disable=SC2086 # words of $parts are targets
cmake --build "$build" --target $parts >"$work/log" || { cat "$work/log"; exit 1; }

# Some broken lines make loops that do not end. Seconds of processor time: the machine may have other work.
ulimit -t 200

# Runs all tests; prints the name of the one that failed first.
first_failure()
{
    ctest --test-dir "$build" -j "$(nproc)" --stop-on-failure --timeout 3000 \
        -R '^(unit|link|decode|lies)/' 2>/dev/null |
        sed -n '/\*\*\*Skipped/!s/^.*Test *#[0-9]*: \([^ ]*\) .*\*\*\*.*$/\1/p' | head -n 1
}

failing=$(first_failure)
[ -z "$failing" ] || { echo "$failing fails before anything was broken"; exit 1; }

# One mutation a line: file, tab, test, tab, old text, tab, new text.
awk '/^#/ || !NF { next }
     /^- / { old = substr($0, 3); next }
     /^[+] / { print file "\t" old "\t" substr($0, 3); next }
     { file = $1 "\t" $2 }' "$here/mutations.txt" | grep -e "$pattern" >"$work/mutations"

# Puts the new text in place of the old one, which has to be there once.
mutate()
{
    OLD=$2 NEW=$3 awk '
        { at = index($0, ENVIRON["OLD"]) }
        at {
            found++
            $0 = substr($0, 1, at - 1) ENVIRON["NEW"] substr($0, at + length(ENVIRON["OLD"]))
        }
        { print }
        END { exit found != 1 }' "$work/$1" >"$copy/$1"
}

# What notices that a file is broken: nothing is printed when nothing does.
what_notices()
{
    if ! cmake --build "$build" --target "$1" >"$work/log" 2>&1; then
        echo "DOES NOT COMPILE"
    elif ! "$build/tests/bin/$1" >"$work/log" 2>&1; then
        echo "$1"
    else
        # shellcheck disable=SC2086 # words of $parts are targets
        cmake --build "$build" --target $parts >"$work/log" 2>&1
        first_failure
    fi
}

killed=0
tab=$(printf '\t')
while IFS=$tab read -r file test old new <&3; do
    if mutate "$file" "$old" "$new"; then
        outcome=$(what_notices "$test")
        case $outcome in
        '') outcome=SURVIVED ;;
        "DOES NOT COMPILE") ;;
        *) killed=$((killed + 1)) ;;
        esac
    else
        outcome="NOT THERE ONCE"
    fi
    cp "$work/$file" "$copy/$file"
    printf '%-34s %s\n    %s\n    -> %s\n' "$file" "$outcome" "$old" "$new"
done 3<"$work/mutations"
all=$(wc -l <"$work/mutations")
echo "$killed of $all noticed"
[ "$killed" -eq "$all" ]
