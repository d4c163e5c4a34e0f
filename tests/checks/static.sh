#!/bin/sh
# Usage: static.sh BUILD_DIR [deep]
# clang-tidy, clang's analyzer and cppcheck over all C that was configured in BUILD_DIR. What they look at and what
# not stands with its reasons in .clang-tidy, tests/.clang-tidy and cppcheck.suppressions. The analyzer follows the
# library alone, and each function not for long; with "deep" everything, for as long as it takes: half an hour of
# processor time. What "deep" then finds outside of the library, some twenty places, are ways through a function that
# no call takes: to be looked at one by one.
set -eu
build=$(cd "$1" && pwd)
deep=${2:-}
here=$(cd "$(dirname "$0")" && pwd)
cd "$here/../.."
root=$(pwd)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# How each file is compiled, once a file, without what only gcc knows.
awk '
    /^\{/ { block = ""; file = "" }
    /^ *"file":/ { file = $2 }
    { block = block $0 "\n" }
    /^\}/ && file ~ /\.c",?$/ && !(file in seen) { seen[file] = 1; blocks[++count] = block }
    END {
        print "["
        for (i = 1; i <= count; i++) {
            sub(/\},?\n$/, i < count ? "},\n" : "}\n", blocks[i])
            gsub(/ -fcallgraph-info=su/, "", blocks[i])
            printf "%s", blocks[i]
        }
        print "]"
    }' "$build/compile_commands.json" >"$work/compile_commands.json"
sed -n "s|^ *\"file\": \"$root/\(.*\)\",*\$|\1|p" "$work/compile_commands.json" >"$work/files"
# It sins on purpose.
grep -vx 'tests/checks/offender.c' "$work/files" >"$work/tidied" || true
[ -s "$work/tidied" ] || { echo "$build: no C files of $root in its compile_commands.json"; exit 1; }

# Runs clang-tidy on the files of a list, several at once; prints what it finds.
tidy()
{
    list=$1
    shift
    xargs -P "$(nproc)" -n 4 clang-tidy -p "$work" --quiet "$@" <"$list" 2>"$work/messages" || return 1
}

status=0
if [ "$deep" = deep ]; then
    tidy "$work/tidied" || status=1
else
    grep '^lib/' "$work/tidied" >"$work/library"
    tidy "$work/tidied" '--checks=-clang-analyzer-*' || status=1
    tidy "$work/library" '--checks=-*,clang-analyzer-*,-clang-analyzer-security.*' \
        --extra-arg=-Xclang --extra-arg=-analyzer-config --extra-arg=-Xclang --extra-arg=max-nodes=20000 || status=1
fi
grep -v 'warnings\? generated\|^Suppressed\|^Use -header-filter\|treated as error' "$work/messages" || true

# shellcheck disable=SC2046 # words are options and files
cppcheck -j "$(nproc)" --quiet --error-exitcode=1 --std=c11 --enable=warning,performance,portability \
    --suppressions-list="$here/cppcheck.suppressions" \
    $(find lib platform apps/map apps/options apps/render/scene -name '*.h' -printf '-I%h\n' | sort -u) \
    --file-list="$work/tidied" || status=1

echo "$(wc -l <"$work/tidied") files looked at"
exit $status
