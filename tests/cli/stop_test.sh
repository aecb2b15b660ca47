#!/bin/sh
# compare stop: help, exit codes, a table, an error that cannot be got, an interrupted run.
. "$(dirname "$0")/support.sh"
XDG_CACHE_HOME="$scratch/cache"
export XDG_CACHE_HOME

expect 0 "$bin/compare" stop --help
grep -q Example "$scratch/stdout" || fail "compare stop --help shows no example"
expect 2 "$bin/compare" stop
one_line_error SCENE
expect 2 "$bin/compare" stop models/cornell.json --error 0
one_line_error --error

small="--size 32x32 --seeds 5 --threads 1 --reference-spp 2048 --quiet"
expect 0 "$bin/compare" stop models/furnace.json $small --stats - # ends at once, with no error at all
grep -q '"at_once": true' "$scratch/stdout" || fail "compare stop: the furnace did not end at once"
expect 0 "$bin/compare" stop models/spheres.json $small --error 0.002 --stats "$scratch/stop.json"
for key in asked_relmse median_relmse adaptive_to_even samples_per_pixel trials stated_relmse seconds_to_time; do
    grep -q "\"$key\":" "$scratch/stop.json" || fail "compare stop --stats lacks $key"
done
terminated 2 "$bin/compare" stop models/cornell.json --size 64x64 --reference-spp 1000000 --quiet
finish
