# tapemark-render as a whole: what it refuses, what it leaves behind, and that it does the same again.
# usage: test_program.sh FOLDER-OF-expect.sh tapemark-render tapemark-decode VERSION SOURCE-FOLDER
set -eu
program=$2
decode=$3
version=$4
source=$5
. "$1/expect.sh"

# nothing_left: neither the output nor a part of it.
nothing_left() {
    left=$(find . -mindepth 1 ! -name out ! -name err ! -path './given*' | tr '\n' ' ')
    [ -z "$left" ] || fail "left behind: $left"
}

mkdir given
printf 'time_s,x_m,y_m,height_m,heading_deg\n0,1,2,1,-90\n1,2,2,1,-90\n' >given/way.csv
cat >given/map.json <<'MAP'
{"format": "tapemark-map", "version": 1, "units": "m", "plan": {"width_m": 4, "height_m": 3}, "module_mm": 10,
 "segments": [
  {"code": "110", "on": "wall", "above_floor_m": 0.1, "start": [1.0, 0.0], "end": [1.98, 0.0], "direction_deg": 0,
   "cms": [
   {"id": 1, "start": [1.08, 0.0], "end": [1.4, 0.0], "direction_deg": 0},
   {"id": 2, "start": [1.33, 0.0], "end": [1.65, 0.0], "direction_deg": 0},
   {"id": -3, "start": [1.58, 0.0], "end": [1.9, 0.0], "direction_deg": 0}]}]}
MAP
at_map='--map given/map.json --camera 1.5,2,1,-90,-20'

# ---- Usage -----------------------------------------------------------------------------------------------

run 0 --help
expect out 'usage: tapemark-render'
[ "$(wc -L <out)" -le 118 ] || fail 'the help is too wide'
for option in $(grep -o '^    \(TAKEN\|NUMBER\)("[a-z-]*"' "$source/render_options.c" | sed 's/.*"\(.*\)"/\1/'); do
    expect out "--$option"
done
run 0 --version
expect out "tapemark-render $version"

expect_refusal 2 'no output was given'
expect_refusal 2 "unknown option '-q'" -q -o a.png
expect_refusal 2 "option '--colour' is unknown" --colour -o a.png
expect_refusal 2 '--yaw needs a value' -o a.png --yaw
expect_refusal 2 '--yaw: expected a number from -360 to 360, not "nan"' --yaw nan -o a.png
expect_refusal 2 '--size: NV12 comes in groups' --size 641x480 --format NV12 -o a.raw
expect_refusal 2 'need a --camera or a --path' --map given/map.json -o a.pgm
nothing_left

# ---- Files that cannot be read or written ----------------------------------------------------------------

expect_refusal 1 'missing.json: cannot be opened' --map missing.json --camera 1,2,1,0 -o a.pgm
expect_refusal 1 'given/way.csv: ' --map given/way.csv --camera 1,2,1,0 -o a.pgm
expect_refusal 1 'given/map.json: line 1: column' --map given/map.json --path given/map.json -o a.y4m
expect_refusal 1 'given: is a directory' --picture given:60mm -o a.pgm
expect_refusal 1 'given/way.csv: ' --picture given/way.csv:60mm -o a.pgm
printf 'P5\n100 100\n255\nshort' >given/short.pgm
expect_refusal 1 'given/short.pgm: ' --picture given/short.pgm:60mm -o a.pgm
printf 'time_s,x_m,y_m,height_m,heading_deg\n0,1,2,1,-90\n900000,2,2,1,-90\n' >given/long.csv
expect_refusal 1 'lower --fps, or limit --frames' --map given/map.json --path given/long.csv -o a.y4m
printf 'time_s,x_m,y_m,height_m,heading_deg\n0,1,2,1,-90\n1,1,2,1,-90\n1.001,1,2,1,60\n2,1,2,1,60\n' >given/jump.csv
expect_refusal 1 'given/jump.csv: frame 1, at 1 s: the camera turns by more than 90 degrees during the exposure' \
    --map given/map.json --path given/jump.csv --fps 1 --shutter 10ms -o a.y4m
expect_refusal 1 'the readout is out of range, 0 to 1000 exposures' --map given/map.json --path given/way.csv \
    --shutter 0.001ms --readout 10s -o a.y4m
expect_refusal 1 'none/a.pgm: cannot be written: No such file or directory' -o none/a.pgm
expect_refusal 1 'given: is a directory' --format PGM -o given
for format in PGM PNG Y4M NV12; do
    expect_refusal 1 '/dev/full: cannot be written' --format $format -o /dev/full
done
expect_refusal 1 '/dev/full: cannot be written' --truth /dev/full -o a.pgm
expect_refusal 1 'none/t: cannot be written' --truth none/t -o a.pgm
nothing_left
got=0
"$program" --truth - -o a.pgm >&- 2>err || got=$?
[ "$got" -eq 1 ] || fail 'closed standard output'
expect err 'tapemark-render: standard output: is closed'
nothing_left
if (ulimit -f 1 && ! dd if=/dev/zero of=given/big bs=4096 count=64 2>/dev/null); then
    # A limit of a block or so of file size stands for a disk that fills up while frames are written.
    (ulimit -f 100 && expect_refusal 1 'a-000' --frames 4 --size 320x240 -o a.pgm && : >given/limited)
    [ -f given/limited ] || fail 'a limited file was written'
    nothing_left
fi

# ---- What is written -------------------------------------------------------------------------------------

run 0 --frames 3 --size 64x48 --truth truth.jsonl -o many.pgm
[ "$(echo many-*.pgm)" = 'many-0000.pgm many-0001.pgm many-0002.pgm' ] || fail 'numbered files'
expect_lines truth.jsonl 3
cmp -s many-0000.pgm many-0001.pgm && fail 'frames have the same noise'
run 0 --frames 3 --size 64x48 --format PGM -o -
cat many-*.pgm | cmp - out || fail 'frames on standard output differ from those in files'
run 0 --size 64x48 --truth - -o one.png
expect_lines out 1
expect out '"frame": 0'
rm many-*.pgm truth.jsonl one.png

# The same command, the same bytes; another seed, others.
all='--size 160x120 --furnished yes --covered 0.3 --vignetting 0.4 --disc 1 --bloom 0.2 --bloom-size 3 --exposure 1.3'
run 0 $at_map $all --frames 2 --truth first.jsonl -o first.y4m
run 0 $at_map $all --frames 2 --truth again.jsonl -o again.y4m
run 0 $at_map $all --frames 2 --seed 2 --truth other.jsonl -o other.y4m
cmp first.y4m again.y4m || fail 'not the same again'
cmp first.jsonl again.jsonl || fail 'not the same truth again'
! cmp -s first.y4m other.y4m || fail 'the seed changes nothing'
rm first.* again.* other.*

# A path has as many frames as fit into its time, or as few as are wanted.
run 0 --map given/map.json --path given/way.csv --fps 5 --size 64x48 --truth way.jsonl -o way.y4m
expect_lines way.jsonl 6
head -n 1 way.y4m >line
expect line 'W64 H48 F5:1'
expect way.jsonl '"frame": 5, "time_s": 1.0000'
run 0 --map given/map.json --path given/way.csv --fps 5 --frames 2 --size 64x48 --truth way.jsonl -o way.y4m
expect_lines way.jsonl 2
rm way.* line

# What the README shows.
block() {
    sed -n "/<!-- tested: $1 -->/,/^\`\`\`\$/p" "$source/README.md" | sed -e '/^<!--/d' -e '/^```/d'
}
mkdir readme
cp given/map.json readme/map.json
block path >readme/walk.csv
block commands >readme/commands
expect_lines readme/commands 5
run 0 --size 70x70 --background grid-codes -o readme/aruco.png
while read -r name words; do
    [ "$name" = tapemark-render ] || fail "README: $name"
    # shellcheck disable=SC2086
    (cd readme && "$program" $words --size 160x120 >../out 2>../err) || fail "README: $words"
done <readme/commands
expect_lines readme/walk.jsonl 38
[ "$(wc -c <readme/frames.raw)" -eq $((2 * 2 * 160 * 120)) ] || fail 'README: frames.raw'
rm -r readme

# Nothing in view is no error.
run 0 --map given/map.json --camera 1.5,2,1,90 --size 64x48 --truth empty.jsonl -o empty.png
expect empty.jsonl '"cms": [], "segments": [], "pictures": []'

# What is rendered on the map's wall is read there.
run 0 $at_map --size 640x480 -o room.png
"$decode" --map given/map.json --format text room.png >read 2>err || fail 'tapemark-decode'
expect read 'CM -3 at'
expect read 'TM 110 at'
rm empty.* room.png read
nothing_left
