#!/bin/sh
# The same bits for 1, 2 and 7 threads, in both programs, on a scene that uses everything.
. "$(dirname "$0")/support.sh"

small="--size 96x72 --quiet --aov hit,depth,normal,albedo"
for scene in models/cornell.json models/everything.json; do
    for threads in 1 2 7; do
        expect 0 "$bin/raster" $scene -o "$scratch/raster-$threads.exr" --spp 4 --threads $threads $small
        expect 0 "$bin/raytrace" $scene -o "$scratch/raytrace-$threads.exr" --spp 6 --threads $threads $small,variance
        for program in raster raytrace; do
            cmp "$scratch/$program-1.exr" "$scratch/$program-$threads.exr" ||
                fail "$program $scene: $threads threads give other bits than one"
        done
    done
    # A seed that is read changes the image.
    expect 0 "$bin/raytrace" $scene -o "$scratch/seed.exr" --spp 6 --seed 1 $small,variance
    ! cmp -s "$scratch/raytrace-1.exr" "$scratch/seed.exr" || fail "$scene: --seed changes nothing"
done
finish
