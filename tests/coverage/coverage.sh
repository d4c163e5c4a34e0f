#!/bin/sh
# Usage: coverage.sh BUILD_DIR
# Runs the tests of a build of the preset "coverage", prints what they reached of lib, file by file, and what lines
# they did not, with the reason where unreached.txt has one. Fails below 95 % of lines or 90 % of branches of the
# whole, and below 90 % or 80 % of a file.
set -eu
build=$(cd "$1" && pwd)
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

find "$build" -name '*.gcda' -delete
ctest --test-dir "$build" -j "$(nproc)" --output-on-failure --timeout 600 -R '^(unit|link|decode)/' \
    >"$work/tests" || {
    cat "$work/tests"
    exit 1
}
gcovr --root "$root" --filter "$root/lib/" --object-directory "$build" --exclude-unreachable-branches \
    --csv "$work/files.csv" --txt "$work/lines.txt" "$build"

# The text report has the lines that were not reached, as "17,20-22", behind each file's counts.
awk '/^lib\/.*%/ && NF > 4 {
        count = split($5, ranges, ",")
        for (i = 1; i <= count; i++) {
            split(ranges[i], ends, "-")
            for (line = ends[1]; line <= (ends[2] == "" ? ends[1] : ends[2]); line++) print $1, line
        }
    }' "$work/lines.txt" >"$work/unreached"
while read -r file line; do
    text=$(sed -n "${line}s/^ *//p" "$root/$file")
    reason=$(FILE=$file TEXT=$text awk '
        /^#/ { next }
        /^[^ ]/ { file = $1; next }
        / : / && file == ENVIRON["FILE"] {
            at = index($0, " : ")
            known = substr($0, 1, at - 1)
            sub(/^ */, "", known)
            if (known == ENVIRON["TEXT"]) { print substr($0, at + 3); exit }
        }' "$here/unreached.txt")
    printf '%s:%s: %s\n    %s\n' "$file" "$line" "$text" "${reason:-not explained}"
done <"$work/unreached"

awk -F, '
    function part(covered, total) { return total > 0 ? 100 * covered / total : 100 }
    function row(name, lines, branches)
    {
        printf "%-36s %6.1f %% of lines %6.1f %% of branches\n", name, lines, branches
    }
    NR == 1 {
        if ($2 != "line_total" || $3 != "line_covered" || $5 != "branch_total" || $6 != "branch_covered") {
            print "gcovr writes other columns than this script reads"
            exit failed = 1
        }
        next
    }
    {
        lines = part($3, $2); branches = part($6, $5)
        row($1, lines, branches)
        all_lines += $2; lines_reached += $3; all_branches += $5; branches_reached += $6
        # Of a header of a few lines, one branch is a large part.
        if ($5 >= 20 && (lines < 90 || branches < 80)) {
            print $1 ": below 90 % of lines or 80 % of branches"
            failed = 1
        }
    }
    END {
        lines = part(lines_reached, all_lines); branches = part(branches_reached, all_branches)
        row("lib", lines, branches)
        if (all_lines < 1000) { print "next to nothing was counted"; failed = 1 }
        if (lines < 95 || branches < 90) { print "lib: below 95 % of lines or 90 % of branches"; failed = 1 }
        exit failed
    }' "$work/files.csv"
