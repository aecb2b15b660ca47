#!/bin/sh
# The program compare: help, exit codes, an interrupted run leaves nothing behind.
. "$(dirname "$0")/support.sh"

for command in "" run images join ladder skip stress; do
    expect 0 "$bin/compare" $command --help
    grep -q Example "$scratch/stdout" || fail "compare $command --help shows no example"
done
expect 2 "$bin/compare"
one_line_error subcommand
expect 2 "$bin/compare" run models/cornell.json
one_line_error output
expect 2 "$bin/compare" run models/cornell.json -o "$scratch/report" --size 12
one_line_error --size

expect 0 "$bin/compare" run models/cornell.json -o "$scratch/report" --size 32x32 --spp 4 --quiet --stats -
[ ! -s "$scratch/stderr" ] || fail "--quiet is not quiet"
for key in raster raytrace metrics mse rmse mae psnr relmse mean_signed_error hits pixels same edge depth_tie \
    unexplained; do
    grep -q "\"$key\":" "$scratch/stdout" || fail "--stats lacks $key"
done
grep -q '"unexplained": 0' "$scratch/stdout" || fail "the pipelines differ without a reason"

expect 0 "$bin/compare" images "$scratch/report/raster.png" "$scratch/report/raster.png" --fail-above mse=0
expect 1 "$bin/compare" images "$scratch/report/raster.png" "$scratch/report/raytrace.png" --fail-above mse=0
one_line_error mse
grep -q "above it by" "$scratch/stderr" || fail "an exceeded limit does not say by how much"
expect 2 "$bin/compare" images "$scratch/report/raster.png" "$scratch/report/raytrace.png" --fail-above speed=0
one_line_error speed
for seed in 1 2; do
    expect 0 "$bin/raytrace" models/cornell.json -o "$scratch/$seed.exr" --size 32x32 --spp 16 --aov variance --seed \
        $seed --quiet
done
expect 0 "$bin/compare" images "$scratch/1.exr" "$scratch/2.exr" --fail-above z_p=1e-6 --fail-above psnr=3
grep -q "alpha" "$scratch/stdout" && fail "the table speaks of an alpha that neither image has"
grep -q "no difference but noise" "$scratch/stdout" || fail "two seeds of one scene differ, or the table does not say"
expect 1 "$bin/compare" images "$scratch/1.exr" "$scratch/2.exr" --fail-above mse=0 --fail-above ssim=1 --fail-above \
    flip=0
[ "$(wc -l <"$scratch/stderr")" -eq 3 ] || fail "three limits exceeded are not three lines"
expect 2 "$bin/compare" images "$scratch/1.exr" "$scratch/report/raster.png"
one_line_error --decode

expect 0 "$bin/compare" skip models/cornell.json --size 16x16 --spp 1 --repeats 1 --only lens --only raster/frustum
grep -q "raster/frustum.*same bits" "$scratch/stdout" || fail "compare skip prints no table"
expect 0 "$bin/compare" skip models/cornell.json --size 16x16 --spp 4 --repeats 1 --only auxiliary
test "$(grep -c "auxiliary.*same bits" "$scratch/stdout")" = 2 || fail "auxiliary images change the image"
expect 2 "$bin/compare" skip models/cornell.json --only nothing
one_line_error raster/back_faces

terminated 2 "$bin/compare" run models/cornell.json -o "$scratch/interrupted" --size 64x64 --spp 10000000 --quiet
nothing_in "$scratch/interrupted"
finish
