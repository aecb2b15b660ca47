#!/bin/sh
# The program compare: help, exit codes, an interrupted run leaves nothing behind.
. "$(dirname "$0")/support.sh"

for command in "" run images; do
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
for key in raster raytrace metrics mse rmse mae psnr relmse mean_signed_error hits pixels same edge depth_tie unexplained; do
    grep -q "\"$key\":" "$scratch/stdout" || fail "--stats lacks $key"
done
grep -q '"unexplained": 0' "$scratch/stdout" || fail "the pipelines differ without a reason"

expect 0 "$bin/compare" images "$scratch/report/raster.png" "$scratch/report/raster.png" --fail-above mse=0
expect 1 "$bin/compare" images "$scratch/report/raster.png" "$scratch/report/raytrace.png" --fail-above mse=0
one_line_error mse
expect 2 "$bin/compare" images "$scratch/report/raster.png" "$scratch/report/raytrace.png" --fail-above speed=0
one_line_error speed

"$bin/compare" run models/cornell.json -o "$scratch/interrupted" --size 64x64 --spp 10000000 --quiet &
process=$!
sleep 2
kill -TERM $process
code=0
wait $process || code=$?
[ "$code" -eq 130 ] || fail "SIGTERM: exit code $code, expected 130"
[ -z "$(ls -A "$scratch/interrupted")" ] || fail "SIGTERM: $(ls -A "$scratch/interrupted") was left behind"
finish
