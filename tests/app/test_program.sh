# tapemark-decode as its users meet it: inputs, formats, errors, exit status.
# usage: test_program.sh FOLDER-OF-THIS-FILE tapemark-decode draw_tape VERSION
set -eu
here=$1
program=$2
draw=$3
version=$4
. "$here/expect.sh"

# ---- Usage ----------------------------------------------------------------------------------------------------

run 0 --help
expect out 'usage: tapemark-decode'
for option in map raw annotate format roll inverted vote-min confidence-min max-id budget help version; do
    expect out "--$option"
done
expect_lines err 0
run 0 --version
[ "$(cat out)" = "tapemark-decode $version" ] || fail 'version'

expect_refusal 2 'no INPUT'
expect_refusal 2 "'--frobnicate'" --frobnicate a.pgm
expect_refusal 2 "'-x'" -x a.pgm
expect_refusal 2 '--format: expected one of jsonl csv text, not "xml"' --format xml a.pgm
expect_refusal 2 '--raw: unknown pixel format' --raw RGB:4x4 a.raw
expect_refusal 2 '--raw: expected FORMAT' --raw GREY:4 a.raw
expect_refusal 2 '--roll: expected a number from -360 to 360' --roll north a.pgm
expect_refusal 2 '--vote-min: expected a number' --vote-min 0.5 a.pgm
expect_refusal 2 '--confidence-min: expected a number' --confidence-min nan a.pgm
expect_refusal 2 '--max-id: expected a whole number from 1 to 1505582' --max-id -3 a.pgm
expect_refusal 2 '--budget: expected a whole number' --budget 4294967296 a.pgm
expect_refusal 2 '--map needs a value' --map

# ---- Formats of output ----------------------------------------------------------------------------------------

"$draw" pgm 1 -20 >cm.pgm
"$draw" pgm 1 12 -13 -14 >tm.pgm
"$draw" y4m 3 5 >walk.y4m

run 0 cm.pgm
expect_lines out 1
number='-\{0,1\}[0-9]*\.[0-9]*'
corner="\[$number,$number\]"
corners="\"corners\":\[$corner,$corner,$corner,$corner\]"
grep -q "^{\"source\":\"cm.pgm\",\"frame\":0,\"width\":640,\"height\":480,\"decode_us\":[0-9]*,\"markers\":\
\[{\"type\":\"cm\",\"id\":-20,$corners,\"confidence\":$number[,}]" out || fail 'shape of a CM'
expect err '1 frame, 1 with a marker read: 1 CM (1 distinct id), 0 TMs; decoding took'

run 0 tm.pgm
grep -q "{\"type\":\"tm\",\"code\":\"100\",\"directed\":true,$corners,\"confidence\":$number,\"cms\":\
\[12,-13,-14\][,}]" out || fail 'shape of a TM'

run 0 --format csv cm.pgm tm.pgm
expect_lines out 6
expect out "source,frame,width,height,decode_us,type,id,code,directed,x0,y0,x1,y1,x2,y2,x3,y3,confidence,cms,x,y,\
direction_deg,agrees,reason"
[ "$(cut -d , -f 1,2,6-9 out | sed -n '2p;6p' | tr '\n' ' ')" = 'cm.pgm,0,cm,-20,, tm.pgm,0,tm,,100,1 ' ] ||
    fail 'csv rows'

run 0 --format text cm.pgm tm.pgm
expect_lines out 5
expect out 'cm.pgm frame 0: CM -20 at (3'
expect out 'tm.pgm frame 0: TM 100 at (3'

# A frame without markers is a line of its own all the same.
"$draw" GREY:640x480 1 1 | head -c 10000 >flat.raw
run 0 --raw GREY:100x1 flat.raw
expect_lines out 100
expect out '"frame":99,"width":100,"height":1,'
expect out '"markers":[]}'
expect err '100 frames, 0 with a marker read'

# ---- Inputs ---------------------------------------------------------------------------------------------------

layouts=
for format in GREY Y10 Y12 Y16 Y10P YUYV UYVY NV12 YU12 SRGGB8 SGRBG10 SBGGR10P; do
    layouts="$layouts $format:640x480"
done
for layout in $layouts GREY:640x480:800 Y10P:640x480:1000 NV12:640x480:2000; do
    "$draw" "$layout" 2 -321 >capture
    run 0 --raw "$layout" capture
    expect_lines out 2
    [ "$(grep -c '"id":-321,' out)" -eq 2 ] || fail "raw $layout"
done
for input in 'pgm cm.pgm' 'y4m walk.y4m'; do
    run 0 "${input#* }"
    sed 's/"source":"[^"]*"/"source":"stdin"/; s/"decode_us":[0-9]*//' out >from_file
    "$program" - <"${input#* }" >out 2>err || fail "standard input: $input"
    sed 's/"decode_us":[0-9]*//' out | cmp -s - from_file || fail "standard input differs: $input"
done
"$draw" NV12:640x480 2 7 | "$program" --raw NV12:640x480 - >out 2>err || fail 'raw standard input'
[ "$(grep -c '"id":7,' out)" -eq 2 ] || fail 'raw standard input'

run 0 walk.y4m
expect_list '0 0.000000 1 0.040000 2 0.080000' '.*"frame":\([0-9]*\),.*"time_s":\([0-9.]*\)}' '\1 \2'

"$draw" -i pgm 1 9 >inverted.pgm
run 0 inverted.pgm
expect_none out '"id":9,'
run 0 --inverted inverted.pgm
expect out '"id":9,'
run 0 --roll 0 --vote-min 0.8 --confidence-min 0.1 --max-id 20 --budget 4000000000 cm.pgm
expect out '"id":-20,'
run 0 --max-id 19 cm.pgm
expect_none out '"id":-20,'

# ---- Directories and names ------------------------------------------------------------------------------------

source_and_frame='.*"source":"\([^"]*\)","frame":\([0-9]*\),.*'
mkdir -p set/below set2
for name in b.pgm a.PGM B.pgm .hidden.pgm below/z.pgm; do
    cp cm.pgm "set/$name"
done
cp walk.y4m set/c.y4m
echo notes >set/notes.txt
echo '{}' >set/truth.json
run 0 set
expect_list 'B.pgm 0 a.PGM 0 b.pgm 0 c.y4m 0 c.y4m 1 c.y4m 2' "$source_and_frame" '\1 \2'
expect err 'set: 2 files left out'

cp cm.pgm set2/b.pgm
run 0 set/ set2/b.pgm --annotate drawn
expect_list 'B.pgm 0 a.PGM 0 set/b.pgm 0 c.y4m 0 c.y4m 1 c.y4m 2 set2/b.pgm 0' "$source_and_frame" '\1 \2'
[ "$(cd drawn && echo *)" = '3-b.pgm-000000.png 5-b.pgm-000000.png B.pgm-000000.png a.PGM-000000.png '\
'c.y4m-000000.png c.y4m-000001.png c.y4m-000002.png' ] || fail "names of annotated frames: $(ls drawn)"
for picture in drawn/*; do
    [ "$(head -c 4 "$picture" | tail -c 3)" = PNG ] || fail "$picture is no PNG"
done

mkdir captures
"$draw" NV12:640x480 1 3 >captures/1.nv12
"$draw" NV12:640x480 2 3 >captures/2.raw
cp cm.pgm captures/3.pgm
echo >captures/4.txt
run 0 --raw NV12:640x480 captures
expect_list '1.nv12 3 2.raw 3 2.raw 3 3.pgm -20' '.*"source":"\([^"]*\)".*"id":\(-*[0-9]*\).*' '\1 \2'

mkdir empty
expect_refusal 1 'empty: this directory holds no pictures or videos' empty

strange=$(printf 'two\nlines "\377".pgm')
cp cm.pgm "$strange"
run 0 "$strange"
expect_lines out 1
expect out '{"source":"two\u000alines \"\ufffd\".pgm"'
rm "$strange"
expect_refusal 1 'two?lines' "$strange"

# ---- Damage ---------------------------------------------------------------------------------------------------

expect_refusal 1 'tapemark-decode: nowhere/a.pgm: cannot be opened: No such file' nowhere/a.pgm
: >empty.png
expect_refusal 1 'tapemark-decode: empty.png: is empty' empty.png
echo 'YUV4MPEG2 W64 H64 F25:1' >header.y4m
expect_refusal 1 'tapemark-decode: header.y4m: holds no frames' header.y4m
expect_refusal 1 'tapemark-decode: set/notes.txt: is no picture or video' set/notes.txt
expect_refusal 1 'cannot be read' /proc/self/mem
if [ "$(id -u)" -ne 0 ]; then
    cp cm.pgm secret.pgm
    chmod 0 secret.pgm
    expect_refusal 1 'secret.pgm: cannot be opened: Permission denied' secret.pgm
fi
printf '\0\0\0\040ftypisom' >video.mp4
got=0
"$program" - <video.mp4 >out 2>err || got=$?
[ "$got" -eq 1 ] || fail 'a video on standard input'
expect_lines err 1
expect err 'tapemark-decode: standard input: this kind of video can only be read from a file'

head -c 800000 walk.y4m >cut.y4m
run 1 cut.y4m cm.pgm
expect_list 'cut.y4m 0 cut.y4m 1 cm.pgm 0' "$source_and_frame" '\1 \2'
[ "$(grep -c '^tapemark-decode: ' err)" -eq 1 ] || fail 'one line about the damage'
expect err 'tapemark-decode: cut.y4m: is cut short: frame 2 needs 307200 bytes'

head -c 1000 cm.pgm >set/aa.pgm
run 1 set
expect_lines out 6
expect err 'tapemark-decode: set/aa.pgm: is cut short'

"$draw" GREY:640x480 2 3 | head -c 400000 >short.raw
run 1 --raw GREY:640x480 short.raw
expect_lines out 1
expect err 'short.raw: is cut short, or not GREY:640x480:640: 92800 bytes are left after 1 whole frames of 307200'

# ---- Output that cannot be written ----------------------------------------------------------------------------

got=0
"$program" cm.pgm >/dev/full 2>err || got=$?
[ "$got" -eq 1 ] || fail 'full disk'
expect_lines err 1
expect err 'standard output: No space left on device'

got=0
"$program" cm.pgm >&- 2>err || got=$?
[ "$got" -eq 1 ] || fail 'closed standard output'
expect_lines err 1

# A reader that goes away: the endless input shows that the program stops by itself.
{
    "$draw" y4m 1 5
    while "$draw" y4m 1 5 | tail -c 307206; do :; done
} 2>/dev/null | { got=0; "$program" - 2>err || got=$?; echo "$got" >status; } | head -n 1 >out
[ "$(cat status)" -ne 0 ] || fail 'broken pipe'
expect_lines out 1
expect_lines err 0

# Each line can be read as soon as its frame is decoded.
mkfifo pipe
"$program" - <pipe >out 2>err &
decoder=$!
exec 3>pipe
"$draw" y4m 1 5 >&3
patience=100
until [ "$(lines out)" -eq 1 ] || [ "$patience" -eq 0 ]; do
    sleep 0.1
    patience=$((patience - 1))
done
[ "$patience" -gt 0 ] || fail 'a line that waits for the next frame'
exec 3>&-
wait "$decoder" || fail 'standard input that ends'

# ---- Annotated frames and maps --------------------------------------------------------------------------------

echo >file
expect_refusal 1 'tapemark-decode: file: is not a directory' --annotate file cm.pgm
expect_refusal 1 'cannot be made' --annotate nowhere/drawn cm.pgm
mkdir -p blocked/cm.pgm-000000.png
run 1 --annotate blocked cm.pgm walk.y4m
expect err 'blocked: blocked/cm.pgm-000000.png cannot be written'
expect_lines err 1

echo '[{"idcm_decimal":-20,"x":1.25,"y":-2},{"idcm_decimal":5,"x":0,"y":0}]' >map.json
run 0 --map map.json cm.pgm tm.pgm
expect out '"x":1.2500,"y":-2.0000}'
expect_none out '"id":12'
expect_refusal 1 'tapemark-decode: map.jsn: cannot be opened' --map map.jsn cm.pgm
head -c 30 map.json >cut.json
expect_refusal 1 'cut.json: is not valid JSON: it ends too early at line 1, column 31' --map cut.json cm.pgm

# ---- On a terminal --------------------------------------------------------------------------------------------

# script(1) gives the program a terminal to write to. The second frame comes when progress is told of, the third when
# that was seen and is due again. What a name holds is shown there, and not obeyed.
escape=$(printf '\033')
mv pipe "pi${escape}[2Jpe"
{
    "$draw" y4m 1 5
    sleep 1.2
    "$draw" y4m 1 5 | tail -c 307206
    patience=300
    until grep -qsF 'frame 2' terminal || [ "$patience" -eq 0 ]; do
        sleep 0.1
        patience=$((patience - 1))
    done
    sleep 0.3
    "$draw" y4m 1 5 | tail -c 307206
} >"pi${escape}[2Jpe" &
script -qfec "'$program' 'pi${escape}[2Jpe' >out" terminal >/dev/null </dev/null || fail 'a run on a terminal'
wait
expect_lines out 3
expect terminal 'pi?[2Jpe: frame 2'
expect terminal 'pi?[2Jpe: frame 3'
expect terminal '3 frames, 3 with a marker read'
sed 1d terminal >shown # script(1) begins with the command
expect_none shown "${escape}[2J"
mkdir "se${escape}t"
cp cm.pgm "se${escape}t/c${escape}m.pgm"
echo >"se${escape}t/notes"
run 0 --format text "se${escape}t"
expect out 'c?m.pgm frame 0: CM -20'
expect err 'se?t: 1 file left out'
expect_none out "$escape"
expect_none err "$escape"
run 0 walk.y4m
expect_none err "$(printf '\r')"
