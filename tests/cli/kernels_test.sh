#!/bin/sh
# compare kernels: help, unusable arguments, rows for a mesh and a scene, with the peer and without, an interrupted run.
. "$(dirname "$0")/support.sh"

expect 0 "$bin/compare" kernels --help
grep -q Example "$scratch/stdout" || fail "compare kernels --help shows no example"
expect 2 "$bin/compare" kernels
one_line_error MESH
expect 2 "$bin/compare" kernels models/meshes/none.obj
one_line_error none.obj
expect 2 "$bin/compare" kernels models/meshes/bowl.obj --scene attic
one_line_error attic
expect 2 "$bin/compare" kernels models/meshes/bowl.obj --work reflection
one_line_error reflection
expect 2 "$bin/compare" kernels models/meshes/bowl.obj --peers optix
one_line_error optix
expect 2 "$bin/compare" kernels models/meshes/bowl.obj --repeats 0
one_line_error --repeats
expect 2 "$bin/compare" kernels models/meshes/bowl.obj --stats "$scratch/no/such/folder.json"
one_line_error --stats

short="--size 64x48 --repeats 1 --seconds 0.001"
# A closed mesh, so that rays are aimed at its weak places, too.
expect 0 "$bin/compare" kernels models/meshes/pear.obj models/cornell.json $short --scene alone,room,clutter,instances \
    --threads 2 \
    --watertight 20000 --stats "$scratch/all.json"
for text in "pear, alone" "pear, room" "pear, clutter" "pear, instances" "cornell, alone" "camera-bulk" "bounce" \
    "shadow" "build" "memory" \
    "rays aimed at points, edges and vertices" "judged in double precision: 0 wrong, 0 edge faults" \
        "duet bulk  *0  *0  *0" \
    "camera \*" "repeats"; do
    grep -q "$text" "$scratch/stdout" || fail "the table lacks «$text»"
done
for key in rows mesh scene triangles work threads ours peer peer_name ratio best repeats watertight misses judged \
    wrong edge_faults \
    leaks as_rendered; do
    grep -q "\"$key\":" "$scratch/all.json" || fail "--stats lacks $key"
done
if grep -q '"peer": "embree' "$scratch/all.json"; then
    grep -q "too few" "$scratch/stdout" || fail "the table does not say that one repeat is too few for a range"
    for text in '"peer_name": "embree.* medium"' '"peer_name": "embree.* high-robust packets 16"' '"unexplained": 0' \
        '"ours_edge_faults": 0'; do
        grep -q "$text" "$scratch/all.json" || fail "--stats lacks $text"
    done
    expect 0 "$bin/compare" kernels models/meshes/bowl.obj $short --scene alone --work bounce --peers high --stats -
    grep -q '"peer_name": "embree.* high"' "$scratch/stdout" || fail "--peers high: not found in the rows"
    grep -q '"peer_name": "embree.* medium"' "$scratch/stdout" && fail "--peers high: medium is there, too"
    grep -q '"work": "shadow"' "$scratch/stdout" && fail "--work bounce: shadow is there, too"
else
    grep -q "libembree" "$scratch/stderr" || fail "without the peer nobody says how to install it"
    expect 2 "$bin/compare" kernels models/meshes/bowl.obj $short --peers medium
    one_line_error libembree
fi

expect 0 "$bin/compare" kernels models/meshes/bowl.obj $short --peers none --quiet --stats \
    "$scratch/alone.json"
[ ! -s "$scratch/stdout" ] && [ ! -s "$scratch/stderr" ] || fail "--quiet is not quiet"
grep -q '"peer": null' "$scratch/alone.json" || fail "--peers none: a peer is in the rows"
grep -q '"ratio": null' "$scratch/alone.json" || fail "--peers none: a ratio is in the rows"

"$bin/compare" kernels models/meshes/pear.obj --peers none --repeats 10000 --quiet --stats "$scratch/interrupted.json" &
process=$!
sleep 1
kill -TERM $process
code=0
wait $process || code=$?
[ "$code" -eq 130 ] || fail "SIGTERM: exit code $code, expected 130"
[ ! -e "$scratch/interrupted.json" ] || fail "SIGTERM: figures of an unfinished run were written"
finish
