#!/bin/sh
# compare ladder: help, figures, and an interrupted run that leaves nothing behind.
. "$(dirname "$0")/support.sh"

expect 0 "$bin/compare" ladder --help
for word in Example --size --spp --raster-spp --depth --threads --seed --stats --quiet; do
    grep -qe "$word" "$scratch/stdout" || fail "--help lacks $word"
done
expect 2 "$bin/compare" ladder models/cornell.json
one_line_error output
expect 2 "$bin/compare" ladder missing.json -o "$scratch/report"
one_line_error missing.json
expect 2 "$bin/compare" ladder models/cornell.json -o "$scratch/report" --spp 0
one_line_error --spp

expect 0 "$bin/compare" ladder models/cornell.json -o "$scratch/report" --size 24x24 --spp 4 --quiet --stats -
[ ! -s "$scratch/stderr" ] || fail "--quiet is not quiet"
for key in shares shares_sum rungs visible_pixels difference_rms code note unexplained; do
    grep -q "\"$key\":" "$scratch/stdout" || fail "--stats lacks $key"
done
expect 0 "$bin/compare" ladder models/cornell.json -o "$scratch/report" --size 24x24 --spp 4
grep -q "sum of shares: 1.0000000000" "$scratch/stderr" || fail "the table lacks the sum of the shares"
grep -q "Soft shadows are estimated" "$scratch/stderr" || fail "the table does not say what the rasterizer lacks"

terminated 2 "$bin/compare" ladder models/cornell.json -o "$scratch/interrupted" --size 64x64 --spp 1000000 --quiet
nothing_in "$scratch/interrupted"
finish
