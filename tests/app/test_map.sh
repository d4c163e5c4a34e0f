# tapemark-decode --map, and the examples of the page that describes map files.
# usage: test_map.sh FOLDER-OF-THIS-FILE tapemark-decode draw_tape PAGE
set -eu
here=$1
program=$2
draw=$3
page=$4
. "$here/expect.sh"

example() {
    awk -v mark="<!-- tested: $1 -->" -f "$here/../readme/fence.awk" "$page" >"$2"
    [ -s "$2" ] || fail "no block marked <!-- tested: $1 --> in $page"
}
example map map.json
example 'paper map' paper.json
"$draw" pgm 1 12 -13 -14 >tm.pgm
"$draw" pgm 1 15 >cm.pgm
"$draw" pgm 1 -13 >other.pgm

# ---- Places ---------------------------------------------------------------------------------------------------

for map in map.json paper.json; do
    run 0 --map "$map" tm.pgm
    expect out '"slot":0,"x":0.3057,"y":0.0200,"direction_deg":0.00}'
    expect out '"slot":1,"x":0.5200,"y":0.0200,"direction_deg":0.00}'
    expect out ',"x":0.5200,"y":0.0200,"direction_deg":0.00,"agrees":true}]'
done
run 0 --map map.json cm.pgm
expect out ',"x":1.5000,"y":0.4371,"direction_deg":90.00}'
run 0 --map paper.json cm.pgm
expect out ',"x":1.5000,"y":0.4371}'
run 0 --map map.json other.pgm
expect out ',"x":0.5200,"y":0.0200,"direction_deg":0.00}'
run 0 --map map.json --format csv tm.pgm
expect out ',12 -13 -14,0.5200,0.0200,0.00,true,'
run 0 --map map.json --format text tm.pgm
expect out 'CMs 12 -13 -14, on the plan at (0.52 m, 0.02 m) reading towards 0 deg, its CMs agree'
run 0 tm.pgm
expect_none out '"agrees"'

# ---- Maps that say otherwise ----------------------------------------------------------------------------------

# otherwise REASON SED-COMMAND...: the map changed so, the tape marker contradicts it.
otherwise() {
    reason=$1
    shift
    sed "$@" paper.json >otherwise.json
    run 0 --map otherwise.json tm.pgm
    grep -q "{\"type\":\"tm\",\"code\":\"100\".*\"vote\":[0-9.]*,\"agrees\":false,\"reason\":\"$reason\"}" out ||
        fail "not $reason"
    ! grep -q '"type":"cm",[^}]*"x":' out || fail "$reason: a CM in it has a place"
}
otherwise other_code -e 's/"100"/"1000"/'
otherwise cm_without_tm -e 's/"100"/" "/; s/"n_tm":"1"/"n_tm":" "/'
otherwise other_slot -e 's/:-13,/:-99,/; s/:-14,/:-13,/; s/:-99,/:-14,/'
otherwise unknown_cm -e 's/:12,/:112,/; s/:-13,/:-113,/; s/:-14,/:-114,/'
otherwise unknown_cm -e 's/:-13,/:-113,/'
otherwise backwards -e 's/:12,/:99,/; s/:-14,/:12,/; s/:99,/:-14,/; s/"100"/"001"/'

# ---- Maps that are refused ------------------------------------------------------------------------------------

# refusal TEXT SED-COMMAND: the map changed so is refused with one line. What else can be wrong with a map,
# test_map_own and test_map_file know.
refusal() {
    sed -e "$2" map.json >refused.json
    expect_refusal 1 "tapemark-decode: refused.json: $1" --map refused.json tm.pgm
}
refusal 'segments[0].cms[1]: the id 13 is light, which does not fit the code 100 here' 's/-13/13/'
refusal 'is not valid JSON: error near line 3' 's/"version": 1/"version": 1e/'
expect_refusal 1 'map: is a directory' --map "$(mkdir map && echo map)" tm.pgm
: >empty.json
expect_refusal 1 'empty.json: is not valid JSON: it ends too early at line 1, column 1' --map empty.json tm.pgm
truncate -s 140000000 huge.json
expect_refusal 1 'huge.json: is larger than 128 MB' --map huge.json tm.pgm
if [ "$(id -u)" -ne 0 ]; then
    cp map.json secret.json
    chmod 0 secret.json
    expect_refusal 1 'secret.json: cannot be opened: Permission denied' --map secret.json tm.pgm
fi
