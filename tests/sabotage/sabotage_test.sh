#!/bin/sh
# Run in the preset `sabotage` alone: without any one guard of the numerics `compare stress` must fail in the test that is
# named with it, and with all of them pass.
. "$(dirname "$0")/../cli/support.sh"

"$bin/compare" stress --list | sed -n 's/^sabotage //p' >"$scratch/guards"
[ -s "$scratch/guards" ] || fail "compare stress --list names no guards"

only=$(sed 's/.* /--only /' "$scratch/guards" | sort -u | tr '\n' ' ')
expect 0 "$bin/compare" stress $only
while read -r guard row; do
    expect 1 "$bin/compare" stress --only "$row" --sabotage "$guard" --stats "$scratch/stats.json"
    grep -q "\"sabotage\": \"$guard\"" "$scratch/stats.json" || fail "the figures without $guard do not say so"
    grep -q "^compare: $row: .* trials failed" "$scratch/stderr" || fail "without $guard: $row did not fail by its trials"
done <"$scratch/guards"

expect 2 "$bin/compare" stress --sabotage nothing
one_line_error enlarged-boxes
finish
