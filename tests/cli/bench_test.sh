#!/bin/sh
# compare bench: help, exit codes, an interrupted run, a baseline that something is worse than.
. "$(dirname "$0")/support.sh"
XDG_CACHE_HOME="$scratch/cache"
export XDG_CACHE_HOME

expect 0 "$bin/compare" bench --help
grep -q Example "$scratch/stdout" || fail "compare bench --help shows no example"
expect 2 "$bin/compare" bench
one_line_error SCENE
expect 2 "$bin/compare" bench models/cornell.json --techniques radiosity
one_line_error radiosity
expect 2 "$bin/compare" bench models/cornell.json --exclude 0,0,9999,9999
one_line_error --exclude
expect 2 "$bin/compare" bench models/cornell.json --repeats 1
one_line_error --repeats
expect 2 "$bin/compare" bench models/cornell.json --baseline "$scratch/none.json"
one_line_error none.json

small="--size 16x16 --techniques path --samplers sobol --spp 4 --repeats 5 --threads 1 --reference-spp 256"
expect 0 "$bin/compare" bench models/cornell.json models/furnace.json $small -o "$scratch/report"
grep -q consistent "$scratch/stdout" || fail "no bias check in the table"
for file in index.html report.json bench.csv cornell.svg; do
    [ -s "$scratch/report/$file" ] || fail "$file is missing"
done
[ "$(wc -l <"$scratch/report/bench.csv")" -eq 3 ] || fail "bench.csv: expected a header and two lines"
[ "$(ls "$scratch/cache/duet/references" | wc -l)" -eq 4 ] || fail "expected four references in the cache"

# Against itself nothing is worse (times may drift tenfold here).
expect 0 "$bin/compare" bench models/cornell.json models/furnace.json $small --baseline "$scratch/report/report.json" \
    --drift 9
# An earlier run of a thousand times fewer seconds.
sed '/"seconds": {/,/}/s/"value": [0-9.e-]*/"value": 1e-9/' "$scratch/report/report.json" >"$scratch/fast.json"
expect 1 "$bin/compare" bench models/cornell.json $small --baseline "$scratch/fast.json"
one_line_error slower
expect 2 "$bin/compare" bench models/cornell.json $small --depth 3 --baseline "$scratch/report/report.json"
one_line_error depth

terminated 2 "$bin/compare" bench models/cornell.json -o "$scratch/interrupted" --size 64x64 --reference-spp 1000000 \
    --quiet
nothing_in "$scratch/interrupted"
[ "$(ls "$scratch/cache/duet/references" | grep -cv '\.film\.exr$')" -eq 4 ] || fail \
    "SIGTERM left a reference that is not whole"
finish
