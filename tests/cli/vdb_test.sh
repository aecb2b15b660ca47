#!/bin/sh
# vdb_to_smoke.py turns an OpenVDB file into smoke that the programs draw. It is skipped without OpenVDB for Python.
. "$(dirname "$0")/support.sh"

python=''
for candidate in python3 /usr/bin/python3; do
    if "$candidate" -c 'import numpy, pyopenvdb' 2>/dev/null; then python=$candidate; fi
done
if [ -z "$python" ]; then
    echo "OpenVDB's Python module (Debian: python3-openvdb) is not installed"
    exit 77
fi
convert="$python -B models/vdb_to_smoke.py"

# A box of 10 × 4 × 6 voxels of a tenth of a meter, whose first layer along x is dense.
"$python" - "$scratch/box.vdb" <<'PYTHON'
import sys
import pyopenvdb
grid = pyopenvdb.FloatGrid()
grid.name = "density"
grid.fill((10, 20, 30), (19, 23, 35), 0.5)
grid.fill((10, 20, 30), (10, 23, 35), 2.0)
grid.transform = pyopenvdb.createLinearTransform(0.1)
pyopenvdb.write(sys.argv[1], [grid])
PYTHON

bytes() { od -An -v -tu1 -j "$2" -N "$3" "$1" | tr -s ' '; }
is() { [ "$1" = "$2" ] || fail "found $1, expected $2"; }

expect 0 $convert "$scratch/box.vdb" "$scratch/box.raw"
is "$(cat "$scratch/stdout")" '{"type": "smoke", "low": [0.9, 1.9, 2.9], "high": [2.0, 2.4, 3.6], "scattering": 2.0, '\
'"file": "box.raw", "resolution": [12, 6, 8]}'
cp "$scratch/stdout" "$scratch/medium.json"
# This is row y = 1 of layer z = 1, behind the layers without density.
is "$(bytes "$scratch/box.raw" $((12 * 7)) 12)" ' 0 255 64 64 64 64 64 64 64 64 64 0'

# Blocks of 2³ voxels keep the mean: 1.25 and 0.5. The file's z becomes y, and its y becomes -z.
expect 0 $convert "$scratch/box.vdb" "$scratch/half.raw" --resolution 5 --up z
is "$(cat "$scratch/stdout")" '{"type": "smoke", "low": [0.85, 2.85, -2.45], "high": [2.05, 3.65, -1.85], '\
'"scattering": 1.25, "file": "half.raw", "resolution": [7, 5, 4]}'
is "$(bytes "$scratch/half.raw" $((7 * 6)) 7)" ' 0 255 102 102 102 102 0'

cat >"$scratch/scene.json" <<JSON
{"camera": {"eye": [1.4, 2.1, 8], "look_at": [1.4, 2.1, 3]}, "media": [$(cat "$scratch/medium.json")],
 "environment": {"type": "constant", "radiance": 1}, "objects": []}
JSON
expect 0 "$bin/raytrace" "$scratch/scene.json" --size 16x16 --spp 4 --quiet -o "$scratch/smoke.png"

expect 1 $convert "$scratch/none.vdb" "$scratch/x.raw"
one_line_error none.vdb
expect 0 $convert --help
expect 1 $convert "$scratch/scene.json" "$scratch/x.raw"
one_line_error scene.json
expect 1 $convert "$scratch/box.vdb" "$scratch/x.raw" --grid heat
one_line_error heat
expect 1 $convert "$scratch/box.vdb" "$scratch/x.raw" --resolution 0
one_line_error --resolution
expect 1 $convert "$scratch/box.vdb" "$scratch/none/x.raw"
one_line_error none/x.raw
[ ! -e "$scratch/x.raw" ] || fail "a failed conversion left a file"
finish
