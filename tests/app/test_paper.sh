# tapemark-decode on the pictures and the video that the marker's inventors published.
# usage: test_paper.sh FOLDER-OF-THIS-FILE tapemark-decode FOLDER-OF-THE-DATA
set -eu
here=$1
program=$2
paper=${TAPEMARK_PAPER_DATA:-$3}
if [ ! -d "$paper" ]; then
    echo "there is no $paper (set TAPEMARK_PAPER_DATA to the folder of the paper's data)"
    [ "${TAPEMARK_REQUIRE_PAPER_DATA:-0}" != 1 ] || exit 1
    exit 77
fi
paper=$(cd "$paper" && pwd)
. "$here/expect.sh"

# ids: what was read, in the order of the lines.
ids() {
    grep -o '"type":"cm","id":-*[0-9]*' out | sed 's/.*://' | tr '\n' ' '
}

for id in 15 16 21; do
    run 0 "$paper/markers/CM$id.jpg"
    [ "$(ids)" = "$id " ] || fail "CM$id.jpg: $(ids)"
done

run 0 --map "$paper/map.json" "$paper/markers/tape_6_11.png"
[ "$(ids)" = '-6 -7 -8 -9 -10 11 ' ] || fail "tape_6_11.png: $(ids)"
expect out '"code":"000001","directed":true,'
expect out '"cms":[-6,-7,-8,-9,-10,11]'
expect out '"x":1.7566,"y":0.1100,"direction_deg":0.00}'
expect out '"x":2.3411,"y":0.1100,"direction_deg":0.00,"agrees":true}'  # the middle of the tape marker

run 0 "$paper/markers"
expect_none out '"markers":[]'

run 0 "$paper/condition_a/tape.mp4"
expect_lines out 100
expect_list "$(seq -s ' ' 0 99)" '.*"frame":\([0-9]*\),"width":1080,"height":1920,.*' '\1'
[ "$(grep -c '"markers":\[{' out)" -ge 80 ] || fail 'frames of the video without a marker'
