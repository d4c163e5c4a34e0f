#!/bin/sh
# Usage: soak_scenes.sh BUILD_FOLDER FOLDER
# Renders what the long soak plays: recordings into FOLDER/recordings, and the truth about all their frames, in the
# order in which a directory is played, into FOLDER/truth.jsonl. About 1500 frames: walks, rooms, tapes that are far
# away, oblique, blurred, dark, over-exposed, in shadow, covered or damaged, and clutter without any tape.
set -eu
render=$1/bin/tapemark-render
folder=$2
data=$(cd "$(dirname "$0")/../../data" && pwd)
mkdir -p "$folder/recordings"
rm -f "$folder"/recordings/*.y4m "$folder"/*.jsonl

number=100
# scene OPTION...: one recording.
scene()
{
    number=$((number + 1))
    "$render" --seed "$number" --noise 0.6 --shot-noise 1.2 "$@" --truth "$folder/$number.jsonl" \
        -o "$folder/recordings/$number.y4m"
}

# Rows that differ from round to round: a tape and other ids each time, and it hangs elsewhere.
for round in 1 2 3 4 5 6 7 8 9 10; do
    id=$((37 * round * round))
    ids=$id,-$((id + 1)),$((id + 2)),-$((id + 3))
    x=$((round * 13 % 41 - 20))
    y=$((round * 7 % 31 - 15))
    roll=$((round * 67 % 360))
    row="--frames 8 --x $x --y $y --ids"
    # shellcheck disable=SC2086 # options are words
    {
        scene --size 480x270 $row $ids --roll $roll --px-per-module 2.5
        scene --size 640x480 $row $ids --roll $((roll % 30 - 15)) --px-per-module 1.$((round % 10)) \
            --background text --scale 4
        scene --size 480x270 $row $ids --roll $((roll % 20)) --px-per-module 3.4 --yaw $((5 * round + 10)) \
            --background popcorn
        scene --size 320x240 $row $ids --px-per-module 2.2 --motion $((round % 5)).5 --motion-angle $((round * 31))
        scene --size 320x240 $row $ids --px-per-module 2.3 --defocus 1.$round
        scene --size 480x270 $row $ids --px-per-module 2.8 --exposure 0.$((round + 2)) --gradient 0.3
        scene --size 480x270 $row $ids --px-per-module 2.8 --exposure 2.$round --bloom 0.2 --bloom-size 3
        scene --size 320x240 $row $ids --px-per-module 2.2 --shadow 0.$((round % 6 + 2)) \
            --shadow-angle $((round * 20)) --background blinds --angle 70
        scene --size 480x270 $row $ids --px-per-module 3 --roll $((roll % 40)) --covered 0.$((round % 5 + 1))
        scene --size 480x270 --frames 8 --ids $id --px-per-module 4.$((round % 10)) --roll $roll \
            --jpeg $((30 + 5 * round))
    }
    # None there at all.
    for background in noise popcorn blinds checkerboard stripes text squares; do
        scene --size 320x240 --frames 3 --ids 1 --px-per-module 2 --x 5000 --background $background \
            --scale $((round + 3)) --angle $((round * 17))
    done
done

scene --scene walk --size 480x270 --frames 96
scene --scene walk --size 640x360 --frames 96 --jpeg 60
for heading in -62 30 118 210; do
    cat >"$folder/way.csv" <<CSV
time_s,x_m,y_m,height_m,heading_deg,pitch_deg
0,2.2,1.9,0.7,$heading,-14
1.5,3.1,2.1,0.7,$((heading + 40)),-14
2,3.2,1.8,0.7,$((heading + 85)),-10
CSV
    scene --map "$data/map.json" --path "$folder/way.csv" --fps 24 --shutter 4ms --focal 330 --size 480x270 \
        --furnished yes
done
rm -f "$folder/way.csv"
cat "$folder"/[0-9]*.jsonl >"$folder/truth.jsonl"
