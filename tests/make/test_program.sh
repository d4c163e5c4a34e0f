# tapemark-make as its users meet it: files, summary, errors, exit status, nothing half-written.
# usage: test_program.sh FOLDER-OF-EXPECT.SH tapemark-make tapemark-decode VERSION README.md
set -eu
here=$1
program=$2
decode=$3
version=$4
readme=$(cd "$(dirname "$5")" && pwd)/$(basename "$5")
. "$here/expect.sh"

# files FOLDER: its entries, hidden ones as well.
files() {
    (cd "$1" && ls -A | tr '\n' ' ')
}

expect_files() {
    [ "$(files "$1")" = "$2" ] || fail "files in $1: $(files "$1")instead of $2"
}

# What is here: names of all files and directories, and what the files hold. What the last run said does not count.
snapshot() {
    find . ! -name out ! -name err -print | sort
    find . -type f ! -name out ! -name err -exec cksum {} + | sort
}

# expect_untouched TEXT ARGUMENT...: exit status 1, one line with the text, and all is as it was.
expect_untouched() {
    text=$1
    shift
    snapshot >../before
    expect_refusal 1 "$text" "$@"
    snapshot | cmp -s ../before - || fail "not all is as it was: $*"
}

mkdir here
cd here

# ---- Usage ----------------------------------------------------------------------------------------------------

run 0 --help
expect out 'usage: tapemark-make PLAN.json -o DIRECTORY'
for option in line cms output height module first-id tm-cms tm-cms-max camera-upright paper measured scale scale-x \
    scale-y only svg png pgm no-labels paper-map quiet help version; do
    expect out "--$option"
done
expect_lines err 0
run 0 --version
[ "$(cat out)" = "tapemark-make $version" ] || fail 'version'
expect_refusal 2 'tapemark-make: expected one of PLAN.json, --line and --cms, not none'
expect_refusal 2 "tapemark-make: option '--frobnicate' is unknown" --frobnicate
expect_refusal 2 'tapemark-make: where to? -o DIRECTORY is missing' --cms 6 -o ''
expect_refusal 2 'tapemark-make: --only: 5..7 is not all on this tape, which has the ids 0 to 5' \
    --cms 6 --only 5..7 -o made
expect_files . 'err out '

# ---- Tapes without a plan -------------------------------------------------------------------------------------

run 0 --cms 6 -o made
expect_files made 'map.json tape.pdf '
expect out '6 CMs, ids 0 to 5: 1 TM of 6'
expect out '1.52 m of tape on 1 line of 1.52 m, 60 mm tall'
expect out 'tape.pdf: '
expect_lines err 0
expect made/map.json '"code": "100000"'
[ "$(head -c 5 made/tape.pdf)" = %PDF- ] || fail 'no PDF'

run 0 --cms 1 --first-id 7 -o made
expect out '1 CM, id 7: 1 CM alone'
run 0 --line 3.1m --module 5mm --paper roll -o made --svg --png 101.6 --pgm 101.6 --paper-map --quiet
expect_lines out 0
pieces=$(for piece in 001-cm0000-0005 002-cm0006-0011 003-cm0012-0017; do
    for ending in pgm png svg; do
        printf 'tape-%s.%s ' "$piece" "$ending"
    done
done)
expect_files made "map.json paper-map.json ${pieces}tape-004-cm0018.pgm tape-004-cm0018.png tape-004-cm0018.svg \
tape-005-cm0019.pgm tape-005-cm0019.png tape-005-cm0019.svg tape.pdf "
[ "$(grep -o '"idcm_decimal"' made/paper-map.json | wc -l)" -eq 20 ] || fail "CMs in the inventors' map"

# What was made is read again: ids, codes and places.
for map in map paper-map; do
    "$decode" --map "made/$map.json" made/tape-002-cm0006-0011.png >out 2>err || fail 'made pictures are not read'
    expect out '"type":"tm","code":"010000","directed":true,'
    expect out '"cms":[-6,7,-8,-9,-10,-11]'
    expect out '"x":1.3275,"y":0.0000'
done

# The same again is the same again.
mkdir again
run 0 --line 3.1m --module 5mm --paper roll -o again --svg --png 101.6 --pgm 101.6 --paper-map --quiet
diff -r made again >err || fail 'not the same twice'
rm -r again

# Pieces to mend a tape with leave the rest alone.
echo >>made/tape.pdf
echo >>made/map.json
cp made/tape.pdf made/map.json .
run 0 --line 3.1m --module 5mm -o made --only 17..18
expect out 'repair.pdf: '
cmp -s tape.pdf made/tape.pdf || fail 'a repair touched the tape'
cmp -s map.json made/map.json || fail 'a repair touched the map'
[ -s made/repair.pdf ] || fail 'no repair'
rm -r made tape.pdf map.json

# ---- Plans ----------------------------------------------------------------------------------------------------

plan() {
    printf '{"room_m":[3.7,6.2],"tape_height_mm":30%s,"lines":[%s]}' "$1" "$2" >plan.json
}
upper='{"from_m":[0.12,0.11],"to_m":[3.6,0.11],"above_floor_m":0.03}'

plan ',"first_id":7,"tm_cms":4' "$upper,{\"from_m\":[1,1],\"to_m\":[1,2],\"on\":\"floor\"}"
run 0 plan.json -o made
expect_files made 'map.json plan.png tape.pdf '
expect out '32 CMs, ids 7 to 38: 1 TM of 5, 6 TMs of 4, 3 CMs alone'
expect made/map.json '"on": "floor"'
expect made/map.json '"above_floor_m": 0.03'
for file in map.json plan.png tape.pdf; do
    [ -s "made/$file" ] || fail "$file is empty"
done

# plan_error MEMBERS LINES TEXT
plan_error() {
    plan "$1" "$2"
    expect_untouched "tapemark-make: plan.json: $3" plan.json -o made
}
# What else can be wrong with a plan, test_plan and test_layout know.
plan_error '' "$upper,{\"from_m\":[1,1],\"to_m\":[1,7.1]}" \
    'lines[1].to_m[1]: 7.1 m is outside of the room, 0 to 6.2'
plan_error ',"first_id":1505570' "$upper" 'ids end at 1505582: from 1505570 on they cover 1.5 m of the 3.5 m wanted'
plan ',"background":"floor.png"' "$upper"
expect_untouched 'floor.png: cannot be opened: No such file or directory' plan.json -o new
echo 'no picture' >floor.png
expect_untouched 'floor.png: is no picture' plan.json -o made
rm floor.png
printf '{"room_m":[3.7,' >plan.json
expect_untouched 'plan.json: is not valid JSON: it ends too early at line 1, column 16' plan.json -o made
expect_untouched 'tapemark-make: made: is a directory' made -o made
expect_untouched 'tapemark-make: --line: a line of 0.2914 m is shorter than a CM' --line 29.14cm -o made
expect_untouched 'tapemark-make: two?lines.json: cannot be opened' "$(printf 'two\nlines.json')" -o made

# What the page about plans shows. in_readme MARK: the block behind this mark.
in_readme() {
    sed -n "/^<!-- tested: $1 -->\$/,/^\`\`\`\$/p" "$readme" | sed '1,2d;$d'
}
in_readme plan >shown.json
run 0 shown.json -o shown
in_readme summary >summary
[ "$(lines summary)" -eq 2 ] && head -n 2 out | cmp -s summary - || fail 'the page about plans shows another summary'
rm -r shown shown.json summary

# ---- Places that cannot be written ----------------------------------------------------------------------------

plan '' "$upper"
echo >file
expect_untouched 'tapemark-make: file: is not a directory' plan.json -o file
expect_untouched 'tapemark-make: no/where: cannot be made: No such file or directory' plan.json -o no/where
expect_untouched 'tapemark-make: /proc: cannot be written to' plan.json -o /proc
rm made/tape.pdf
mkdir made/tape.pdf
expect_untouched 'tapemark-make: made: tape.pdf is a directory, and not to be replaced by a file' plan.json -o made
rmdir made/tape.pdf
run 0 plan.json -o made

# Files may have so many blocks of 512 bytes, a little less than one of them takes: like a full disk.
for file in map.json plan.png tape.pdf; do
    blocks=$((($(wc -c <"made/$file") - 1) / 512))
    for folder in made $([ "$file" = tape.pdf ] && echo new); do
        snapshot >../before
        got=0
        (
            ulimit -f "$blocks"
            exec "$program" plan.json -o "$folder"
        ) >out 2>err || got=$?
        [ "$got" -eq 1 ] || fail "exit status $got with files of $blocks blocks"
        expect_lines err 1
        expect err "tapemark-make: $folder/"
        expect err 'File too large'
        snapshot | cmp -s ../before - || fail "something is left of a run with files of $blocks blocks"
    done
done

got=0
"$program" --help >/dev/full 2>err || got=$?
[ "$got" -eq 1 ] || fail 'full disk under standard output'
expect_lines err 1
expect err 'standard output: No space left on device'

got=0
"$program" --cms 3 -o made >&- 2>err || got=$?
[ "$got" -eq 1 ] || fail 'closed standard output'
expect err 'tapemark-make: standard output: is closed'

# ---- Interruption ---------------------------------------------------------------------------------------------

plan '' "$upper,$upper,$upper,$upper,$upper,$upper"
run 0 plan.json -o whole
snapshot >../before

# Whenever it was told to stop, all is made or nothing is.
expect_all_or_nothing() {
    if [ -d cut ]; then
        diff -r cut whole >/dev/null || fail 'half-written files'
        rm -r cut
    fi
    snapshot | cmp -s ../before - || fail "something is left after $1"
}

for pause in 0.05 0.3; do
    timeout -s INT "$pause" "$program" plan.json -o cut >out 2>err || :
    expect_all_or_nothing "SIGINT at $pause s"
done

# As soon as there is something to be half-written. A shell has what it starts beside itself ignore SIGINT.
for signal in TERM HUP; do
    "$program" plan.json -o cut >out 2>err &
    child=$!
    while kill -0 "$child" 2>/dev/null && [ -z "$(find . -name '.unfinished-*' 2>/dev/null)" ]; do
        :
    done
    kill -s "$signal" "$child" 2>/dev/null || :
    wait "$child" || :
    expect_all_or_nothing "SIG$signal"
done
