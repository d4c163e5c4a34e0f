#!/bin/sh
# usage: test_clutter.sh TESTS_APP TAPEMARK_CLUTTER TAPEMARK_RENDER
# No code marker is read where there is no tape, and tapemark-clutter would tell if one were.
set -u
program=$2
render=$3
. "$1/expect.sh"

kinds=19
frames=10

# numbers NAME [KIND]: from the last part of the report, for each kind or for one.
numbers() {
    sed -n "s/.*\"kind\":\"${2:-[a-z-]*}\",\"frames\".*\"$1\":\\([0-9.]*\\).*/\\1/p" out
}

# ---- Nothing is read, though there is something to look at --------------------------------------------------------

run 0 --frames $frames --strict
expect_lines err 0
[ "$(numbers cms | wc -l)" -eq $kinds ] || fail "not $kinds kinds"
[ "$(numbers cms | sort -u)" = 0 ] || fail "code markers where there are none"
[ "$(numbers tms | sort -u)" = 0 ] || fail "tape markers where there are none"
for kind in finder-lattice finder-rows qr-rows random-cells; do
    [ "$(numbers frames_with_finders $kind)" -ge $((frames / 2)) ] || fail "hardly any finder pattern in $kind"
done
for kind in finder-lattice finder-rows random-cells; do
    [ "$(numbers frames_with_candidates $kind)" -ge $((frames / 2)) ] || fail "hardly anything to be read in $kind"
done

# ---- Frames that once misled ---------------------------------------------------------------------------------------

# Finder patterns with stripes, checks and dots between them, whose best words happened to ascend; the same between
# gratings that passed for bars; blocks between bars, too small for the patterns to be seen.
while read -r kind numbers; do
    for number in $numbers; do
        run 0 --kinds "$kind" --first "$number" --frames 1 --strict
        expect_none out '"type":'
        expect out "\"kind\":\"$kind\",\"frames\":1,"
    done
done <<END
finder-lattice 78 265 898 954 1034 1731 3156 734 854 1463 1778 1824 11448
random-cells 1655 13420 14697
finder-carpet 1909 2313
finder-rows 2716
bars-and-blocks 1318 1681 2610
END

# ---- A tape among the sheets is told, with its pictures ------------------------------------------------------------

mkdir sheets kept
"$render" --ids 5,-6,7 --px-per-module 6 --size 1024x512 --light 255 -o sheets/tape-00.png || fail "no sheet"
run 1 --sheets sheets --kinds tape,tiles --frames 12 --strict --keep kept
expect_lines err 1
expect err "code markers were read where there are none"
expect out '"id":-6,'
expect out '{"kind":"tape","frames":12,'
expect_none out '{"kind":"tiles","frame":'
[ "$(find kept -name 'tape-0000*.pgm' | wc -l)" -eq "$(grep -c '"kind":"tape","frame":' out)" ] ||
    fail "not a picture for each frame with a reading"
run 0 --sheets sheets --kinds tape --frames 12 -o report.json
expect_lines out 0
grep -q '"id":-6,' report.json || fail "no report in its file"

# ---- A frame depends on its kind, number and seed alone ------------------------------------------------------------

bytes=$((640 * 480))
run 0 --kinds shelves,stripes --frames 3 --raw all.raw
run 0 --kinds stripes --first 1 --frames 2 --raw - -o report.json
[ "$(wc -c <all.raw)" -eq $((6 * bytes)) ] || fail "not six frames of 640 x 480"
tail -c $((2 * bytes)) all.raw | cmp -s - out || fail "other frames when begun later"
run 0 --kinds stripes --first 1 --frames 2 --seed 2 --raw - -o report.json
tail -c $((2 * bytes)) all.raw | cmp -s - out && fail "the same frames with another seed"

# ---- What is wrong is told in one line -----------------------------------------------------------------------------

expect_refusal 2 "--kinds: a name in 'tiles,slates' is of no kind" --kinds tiles,slates
expect_refusal 2 "--frames" --frames 0
expect_refusal 2 "--frames needs a value" --frames
expect_refusal 2 "option '--colour' is unknown, ambiguous or takes no value" --colour
expect_refusal 2 "unexpected argument" tiles
expect_refusal 2 "--raw and --output" --raw -
expect_refusal 1 "nowhere" --sheets nowhere
expect_refusal 1 "--output nowhere/report.json" -o nowhere/report.json --frames 1
expect_refusal 1 "nowhere/tape-000" --sheets sheets --kinds tape --frames 12 --keep nowhere -o report.json
mkdir broken
echo "P5 9 9 255" >broken/short-00.pgm
expect_refusal 1 "broken/short-00.pgm" --sheets broken --kinds short --frames 1 -o report.json
run 1 --kinds tiles --frames 1 -o /dev/full
expect err "/dev/full"
run 1 --kinds tiles --frames 1 --raw /dev/full -o report.json
expect err "/dev/full"
