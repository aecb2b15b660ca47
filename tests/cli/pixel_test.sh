#!/bin/sh
# --pixel: a sample's path in words, without an image.
. "$(dirname "$0")/support.sh"

expect 0 "$bin/raytrace" models/cornell.json --size 64x64 --pixel 32,40,1
for text in "pixel 32,40, sample 1" "vertex 0: object" "light sample light" "throughput" "path: "; do
    grep -qF "$text" "$scratch/stdout" || fail "--pixel does not tell «$text»"
done
expect 2 "$bin/raytrace" models/cornell.json --size 64x64 --pixel 64,0
one_line_error "expected a pixel of the image of 64 x 64"
expect 2 "$bin/raytrace" models/cornell.json --pixel 7
one_line_error "expected x,y or x,y,sample"
expect 2 "$bin/raytrace" models/cornell.json
one_line_error "no output: expected -o"
finish
