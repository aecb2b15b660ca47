#!/bin/sh
# raster --shading, --msaa, --edges: each name shows something of its own; what there is not is refused.
. "$(dirname "$0")/support.sh"

names='lit phong gouraud flat toon wireframe lines edges normal albedo depth'
expect 0 "$bin/raster" --help
for word in $names --msaa --sample-shading --edges Example; do
    grep -q -e "$word" "$scratch/stdout" || fail "raster --help does not mention $word"
done

scene=models/amphora.json
sums=
for name in $names; do
    expect 0 "$bin/raster" $scene --size 96x64 --quiet --shading $name -o "$scratch/$name.ppm"
    sum=$(cksum < "$scratch/$name.ppm")
    case "$sums" in
    *"$sum"*) fail "--shading $name shows what another shading shows" ;;
    esac
    sums="$sums $sum"
done
expect 2 "$bin/raster" $scene --shading fancy -o "$scratch/no.ppm"
one_line_error '"lit", "phong", "gouraud", "flat", "toon", "wireframe", "lines", "edges", "normal", "albedo", "depth"'

expect 0 "$bin/raster" $scene --size 96x64 --quiet --shading phong --msaa 8 -o "$scratch/msaa.ppm" --stats \
    "$scratch/msaa.json"
grep -q '"samples_per_pixel": 8' "$scratch/msaa.json" || fail \
    "the statistics of --msaa 8 name another number of samples"
cmp -s "$scratch/msaa.ppm" "$scratch/phong.ppm" && fail "--msaa 8 changes nothing"
expect 0 "$bin/raster" $scene --size 96x64 --quiet --shading phong --msaa 8 --sample-shading -o "$scratch/each.ppm"
cmp -s "$scratch/msaa.ppm" "$scratch/each.ppm" && fail "--sample-shading changes nothing"
expect 0 "$bin/raster" $scene --size 96x64 --quiet --shading phong --edges -o "$scratch/inked.ppm"
cmp -s "$scratch/inked.ppm" "$scratch/phong.ppm" && fail "--edges changes nothing"

expect 2 "$bin/raster" $scene --msaa 5 -o "$scratch/no.ppm"
one_line_error "2, 4, 8 or 16"
expect 2 "$bin/raster" $scene --sample-shading -o "$scratch/no.ppm"
one_line_error --msaa
expect 2 "$bin/raster" $scene --msaa 4 --spp 2 -o "$scratch/no.ppm"
one_line_error multisampling
expect 2 "$bin/raster" $scene --msaa 4 --edges -o "$scratch/no.ppm"
one_line_error edges
finish
