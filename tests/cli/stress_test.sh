#!/bin/sh
# compare stress: a tenth of its trials pass, with the same figures for any number of threads; names, files, signals.
. "$(dirname "$0")/support.sh"

expect 0 "$bin/compare" stress --trials 0.1 --stats "$scratch/all.json"
for key in tests name what trials failures worst bound unit source naive; do
    grep -q "\"$key\":" "$scratch/all.json" || fail "--stats lacks $key"
done
for group in arithmetic leak intersection departure material light coverage projection pipeline scenes; do
    grep -q "^ok  *$group/" "$scratch/stdout" || fail "no row of $group/"
done
grep -q FAILED "$scratch/stdout" && fail "a row is red, and the exit code 0"

for threads in 1 3; do
    expect 0 "$bin/compare" stress --only arithmetic --only departure/instances --trials 0.02 --seed 7 \
        --threads $threads --quiet --stats "$scratch/threads-$threads.json"
    [ ! -s "$scratch/stdout" ] && [ ! -s "$scratch/stderr" ] || fail "--quiet is not quiet"
done
cmp -s "$scratch/threads-1.json" "$scratch/threads-3.json" || fail "the rows depend on the number of threads"

expect 0 "$bin/compare" stress --list --only leak/edges
grep -q "aimed at its edges" "$scratch/stdout" || fail "--list does not say what leak/edges is"
expect 2 "$bin/compare" stress --only nothing
one_line_error "arithmetic, "
expect 2 "$bin/compare" stress --trials 0
one_line_error --trials
expect 2 "$bin/compare" stress --stats "$scratch/no/such/folder.json"
one_line_error --stats

terminated 1 "$bin/compare" stress --trials 1000 --quiet --stats "$scratch/interrupted.json"
[ ! -e "$scratch/interrupted.json" ] || fail "SIGTERM: figures of an unfinished run were written"
finish
