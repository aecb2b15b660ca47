#!/bin/sh
# An interrupted path tracer writes what it has and returns 130; killed outright it leaves no half-written file.
. "$(dirname "$0")/support.sh"

for signal in INT TERM; do
    rm -f "$scratch/out.png"
    # A shell starts background jobs with SIGINT ignored, and a handler set over that still catches it.
    "$bin/raytrace" models/cornell.json -o "$scratch/out.png" --size 64x64 --spp 10000000 --quiet --stats \
        "$scratch/stats.json" &
    process=$!
    sleep 2
    kill -0 $process || fail "the render ended by itself"
    kill -$signal $process
    code=0
    wait $process || code=$?
    [ "$code" -eq 130 ] || fail "SIG$signal: exit code $code, expected 130"
    [ -s "$scratch/out.png" ] || fail "SIG$signal: no image was written"
    grep -q '"interrupted": true' "$scratch/stats.json" || fail "SIG$signal: the statistics do not say so"
done

rm -f "$scratch"/out* "$scratch"/.out*
"$bin/raytrace" models/cornell.json -o "$scratch/out.png" --size 64x64 --spp 10000000 --quiet &
process=$!
sleep 1
kill -9 $process
wait $process || true
[ -z "$(ls -A "$scratch" | grep out || true)" ] || fail "SIGKILL left $(ls -A "$scratch" | grep out)"
finish
