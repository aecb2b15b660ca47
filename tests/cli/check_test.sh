#!/bin/sh
# compare check: random valid scenes of all kinds are rendered soundly by both pipelines; verdicts, exit codes.
. "$(dirname "$0")/support.sh"

# random_scenes.py draws from every key of the format.
python3 -B tests/fuzz/random_scenes.py "$scratch/scenes" --count 20 --seed 1 >"$scratch/names"
[ "$(wc -l <"$scratch/names")" -eq 20 ] || fail "random_scenes.py did not write 20 scenes"
code=0
"$bin/compare" check - --size 24x24 <"$scratch/names" >"$scratch/stdout" || code=$?
[ "$code" -eq 0 ] || fail "exit code $code of random scenes, expected 0"
[ "$(grep -c '"verdict":"ok"' "$scratch/stdout")" -eq 20 ] || {
    fail "not all of the 20 scenes are sound:"
    grep -v '"verdict":"ok"' "$scratch/stdout"
}

# A file that cannot be loaded is refused, and the others are still checked. The message stays on one line, and
# control characters of the file do not reach the terminal.
printf '{"camera": {"eye": [0,0,5], "look_at": [0,0,0]}, "objects": [], "\001\033[31m": 1}' >"$scratch/bad.json"
expect 2 "$bin/compare" check "$scratch/bad.json" "$(head -1 "$scratch/names")" --size 8x8
[ "$(wc -l <"$scratch/stdout")" -eq 2 ] || fail "expected a line for each of two scenes"
head -1 "$scratch/stdout" | grep -q '"verdict":"refused"' || fail "a broken file is not refused"
tail -1 "$scratch/stdout" | grep -q '"verdict":"ok"' || fail "the scene after a broken one is not checked"
tr -d '\n' <"$scratch/stdout" | grep -q '[[:cntrl:]]' && fail "a control character of the file is printed"
expect 2 "$bin/compare" check "$scratch/bad.json" --memory 1
one_line_error --memory
finish
