#!/bin/sh
# --bvh: the same image at both qualities; cut triangles where that pays; other names are refused.
. "$(dirname "$0")/support.sh"

# A thicket: small triangles among long thin ones.
awk 'BEGIN { srand(7); for (i = 0; i < 3000; ++i) { s = i % 3 ? 0.01 : 1
    x = rand(); y = rand(); z = rand(); a = s * (rand() - 0.5); b = s * (rand() - 0.5); c = s * (rand() - 0.5)
    print "v", x, y, z; print "v", x + a, y + b, z + c; print "v", x + a / 2 + 0.01, y + b / 2, z + c / 2 + 0.01
    print "f", 3 * i + 1, 3 * i + 2, 3 * i + 3 } }' >"$scratch/thicket.obj"
for quality in default high; do
    expect 0 "$bin/raytrace" "$scratch/thicket.obj" -o "$scratch/$quality.pfm" --size 48x32 --spp 2 --quiet --bvh \
        "$quality" \
        --stats "$scratch/$quality.json"
    grep -q "\"quality\": \"$quality\"" "$scratch/$quality.json" || fail "--stats does not say that --bvh is $quality"
done
cmp -s "$scratch/default.pfm" "$scratch/high.pfm" || fail "--bvh high changes the image"
references() { sed -n 's/.*"references": \([0-9]*\).*/\1/p' "$scratch/$1.json"; }
[ "$(references high)" -gt "$(references default)" ] || fail "--bvh high cut no triangle of the thicket"
expect 2 "$bin/raytrace" models/cornell.json -o "$scratch/a.png" --bvh finest
one_line_error "expected default or high"
finish
