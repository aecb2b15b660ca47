#!/bin/sh
# compare frames: help, exit codes, a small measurement.
. "$(dirname "$0")/support.sh"

expect 0 "$bin/compare" frames --help
grep -q Example "$scratch/stdout" || fail "compare frames --help shows no example"
expect 2 "$bin/compare" frames
one_line_error MESH
expect 2 "$bin/compare" frames models/meshes/pear.obj --view sideways
one_line_error --view
expect 2 "$bin/compare" frames models/meshes/pear.obj --threads 1000
one_line_error processors
expect 2 "$bin/compare" frames "$scratch/none.obj"
one_line_error none.obj

expect 0 "$bin/compare" frames models/meshes/pear.obj --size 64x48 --repeats 1 --threads 1 --no-peer --stats "$scratch/rows.json"
grep -q whole "$scratch/stdout" || fail "no row of the whole mesh in the table"
grep -q close "$scratch/stdout" || fail "no row of the mesh close up in the table"
grep -q '"work": "depth"' "$scratch/rows.json" || fail "no row of depths in the JSON"

# With a texture: another picture, and no peer.
expect 0 "$bin/compare" frames models/meshes/pear.obj --texture models/textures/pear.png --size 64x48 --repeats 1 --threads 1 \
    --work phong --view whole -o "$scratch/textured"
expect 0 "$bin/compare" frames models/meshes/pear.obj --size 64x48 --repeats 1 --threads 1 --no-peer --work phong --view whole \
    -o "$scratch/grey"
expect 1 "$bin/compare" images "$scratch/textured/pear-whole-ours.png" "$scratch/grey/pear-whole-ours.png" --fail-above rmse=0.01
expect 2 "$bin/compare" frames models/meshes/pear.obj --texture "$scratch/none.png"
one_line_error none.png
finish
