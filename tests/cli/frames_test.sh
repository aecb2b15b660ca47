#!/bin/sh
# compare frames: help, exit codes, a small measurement.
. "$(dirname "$0")/support.sh"

expect 0 "$bin/compare" frames --help
grep -q Example "$scratch/stdout" || fail "compare frames --help shows no example"
expect 2 "$bin/compare" frames
one_line_error FILE
expect 2 "$bin/compare" frames models/meshes/pear.obj --view sideways
one_line_error --view
expect 2 "$bin/compare" frames models/meshes/pear.obj --threads 1000
one_line_error processors
expect 2 "$bin/compare" frames models/meshes/pear.obj --work gouraud
one_line_error --work
expect 2 "$bin/compare" frames models/meshes/pear.obj --size 64
one_line_error 64
expect 2 "$bin/compare" frames models/meshes/pear.obj --repeats 0
one_line_error --repeats
expect 2 "$bin/compare" frames "$scratch/none.obj"
one_line_error none.obj

expect 0 "$bin/compare" frames models/meshes/pear.obj --size 64x48 --repeats 1 --threads 1 --no-peer --stats \
    "$scratch/rows.json"
grep -q whole "$scratch/stdout" || fail "no row of the whole mesh in the table"
grep -q close "$scratch/stdout" || fail "no row of the mesh close up in the table"
grep -q '"work": "depth"' "$scratch/rows.json" || fail "no row of depths in the JSON"

expect 0 "$bin/compare" frames models/cornell.json --size 64x48 --repeats 1 --threads 1 -o "$scratch/lit" --stats \
    "$scratch/lit.json"
grep -q "direct light" "$scratch/stdout" || fail "no stages of a lit frame"
grep -q '"frame_seconds"' "$scratch/lit.json" || fail "no lit frame in the JSON"
[ -s "$scratch/lit/cornell-lit.png" ] || fail "no image of the lit frame"
expect 2 "$bin/compare" frames "$scratch/none.json"
one_line_error none.json
expect 2 "$bin/compare" frames models/cornell.json --texture models/textures/none.png
one_line_error --texture

# The rows that are requested, and no others: as JSON alone, or not a word.
expect 0 "$bin/compare" frames models/meshes/pear.obj --size 64x48 --repeats 2 --threads 1 --no-peer --view close \
    --work depth --stats -
grep -q '"repeats": 2' "$scratch/stdout" || fail "--repeats 2: not in the JSON"
[ "$(grep -c '"work": "depth"' "$scratch/stdout")" -eq 1 ] || fail "--view close --work depth: not one row"
[ "$(grep -c '"view": "close"' "$scratch/stdout")" -eq 1 ] || fail "--view close: not one row"
grep -q milliseconds "$scratch/stdout" && fail "--stats -: a table beside the JSON"
expect 0 "$bin/compare" frames models/meshes/pear.obj --size 64x48 --repeats 1 --threads 1 --no-peer --quiet
[ -s "$scratch/stdout" ] && fail "--quiet: $(head -1 "$scratch/stdout")"
if [ "$(nproc)" -gt 1 ]; then
    expect 0 "$bin/compare" frames models/meshes/pear.obj --size 64x48 --repeats 1 --threads 1,2 --no-peer --work \
        depth --view whole \
        --stats -
    [ "$(grep -c '"scaling": [0-9]' "$scratch/stdout")" -eq 1 ] || fail \
        "--threads 1,2: no scaling in the second row alone"
fi

# Paused five sixths of the time, a frame takes as much longer by the clock, but no more of the processors.
milliseconds_paused() { # of a frame, with these options
    "$bin/compare" frames models/meshes/pear.obj --size 320x240 --repeats 9 --threads 1 --no-peer --work phong --view \
        whole --quiet \
        --stats "$scratch/paused.json" "$@" &
    process=$!
    while kill -STOP $process 2>/dev/null; do
        sleep 0.05
        kill -CONT $process 2>/dev/null || true # it may have ended just before
        sleep 0.01
    done
    wait $process || fail "paused: exit code $?"
    awk '/"ours":/ { print 1000 / $2 }' "$scratch/paused.json"
}
by_clock=$(milliseconds_paused)
of_processors=$(milliseconds_paused --processor-time)
awk "BEGIN { exit !($of_processors > 0 && $by_clock > 2 * $of_processors) }" ||
    fail "--processor-time: $of_processors ms a frame, $by_clock ms by the clock, paused"

# With a texture: another image, and no peer.
expect 0 "$bin/compare" frames models/meshes/pear.obj --texture models/textures/pear.png --size 64x48 --repeats 1 \
    --threads 1 \
    --work phong --view whole -o "$scratch/textured"
expect 0 "$bin/compare" frames models/meshes/pear.obj --size 64x48 --repeats 1 --threads 1 --no-peer --work phong \
    --view whole \
    -o "$scratch/grey"
expect 1 "$bin/compare" images "$scratch/textured/pear-whole-ours.png" "$scratch/grey/pear-whole-ours.png" \
    --fail-above rmse=0.01
expect 2 "$bin/compare" frames models/meshes/pear.obj --texture "$scratch/none.png"
one_line_error none.png
finish
