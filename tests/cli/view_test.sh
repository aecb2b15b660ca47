#!/bin/sh
# compare view: help and errors; then a real window on a virtual screen, driven by a mouse and keys: select, move, undo,
# orbit, edit, save. The saved files say what was done, and the images are those of the programs.
. "$(dirname "$0")/support.sh"

expect 0 "$bin/compare" view --help
grep -q Example "$scratch/stdout" || fail "compare view --help shows no example"
expect 2 "$bin/compare" view
one_line_error SCENE
if env -u DISPLAY -u WAYLAND_DISPLAY "$bin/compare" view models/cornell.json 2>&1 | grep -q 'built without'; then
    [ -n "${CI:-}" ] && fail "this build has no window"
    echo "SKIPPED: this build has no window"
    exit 77
fi
expect 2 env -u DISPLAY -u WAYLAND_DISPLAY "$bin/compare" view models/cornell.json
one_line_error "needs a screen"
command -v Xvfb >/dev/null && command -v xdotool >/dev/null || {
    [ -n "${CI:-}" ] && fail "Xvfb or xdotool is missing" && finish
    echo "SKIPPED: no Xvfb or no xdotool"
    exit 77
}

mkdir -p "$scratch/models/meshes"
cp models/cornell.json "$scratch/models/"
cp models/meshes/cornell-*.obj "$scratch/models/meshes/"
scene=$scratch/models/cornell.json

mkfifo "$scratch/display"
Xvfb -displayfd 3 -screen 0 1280x800x24 -nolisten tcp 3>"$scratch/display" 2>"$scratch/xvfb.txt" &
server=$!
read -r number <"$scratch/display"
export DISPLAY=":$number"
"$bin/compare" view "$scene" --window 1180x800 --size 200x200 --spp 8 -o "$scratch" 2>"$scratch/view.txt" &
process=$!
trap 'kill $process $server 2>/dev/null || true' EXIT

# until SECONDS COMMAND…: runs it again and again until it succeeds.
until_true() {
    end=$(($(date +%s) + $1))
    shift
    until "$@"; do
        [ "$(date +%s)" -lt "$end" ] || return 1
        sleep 0.3
    done
}
window=$(xdotool search --sync --onlyvisible --name 'Duet' | head -n 1)
xdotool windowmove "$window" 0 0 windowfocus "$window"

key() { xdotool key --window 0 "$@"; sleep 0.4; }
# drag FROM_X FROM_Y BY_X BY_Y: in steps, as a hand does.
drag() {
    xdotool mousemove "$1" "$2"
    sleep 0.4
    xdotool mousedown 1
    sleep 0.2
    for step in 1 2 3 4 5; do
        xdotool mousemove $(($1 + $3 * step / 5)) $(($2 + $4 * step / 5))
        sleep 0.1
    done
    xdotool mouseup 1
    sleep 0.4
}
click() { xdotool mousemove "$1" "$2"; sleep 0.3; xdotool mousedown 1; sleep 0.2; xdotool mouseup 1; sleep 0.4; }
changed_from() {
    key ctrl+s
    ! cmp -s "$scene" "$1"
}

# Writes the window's images until they are final: those that the programs render from the saved scene.
images_match() {
    key p
    [ -f "$scratch/raytrace.exr" ] || return 1
    for program in raster raytrace; do
        "$bin/compare" images "$scratch/$program.exr" "$scratch/expected-$program.exr" --quiet \
            --fail-above rmse=0 >/dev/null 2>&1 || return 1
    done
}
check_images() {
    "$bin/raster" "$scene" -o "$scratch/expected-raster.exr" --size 200x200 --spp 1 --quiet
    "$bin/raytrace" "$scene" -o "$scratch/expected-raytrace.exr" --size 200x200 --spp 8 --aov variance --quiet
    until_true 120 images_match || fail "$1: the images are not those of raster and raytrace"
}
same_as() {
    key ctrl+s
    cmp -s "$scene" "$1"
}

# The image is 800 pixels wide, from the left; the tall box stands left of its middle, its arrow along x at (290, 531).
cp "$scene" "$scratch/original.json"
check_images "at first"
click 330 480
drag 340 531 60 0
until_true 30 changed_from "$scratch/original.json" || fail "moving the box changed nothing"
python3 - "$scratch/original.json" "$scene" <<'CHECK' || fail "the box was not moved along x alone"
import json, sys
before, after = (json.load(open(path)) for path in sys.argv[1:])
box = next(o for o in after["objects"] if o["name"] == "tall box")
(step,) = box.pop("transform")
x, y, z = step["translate"]
assert 0.1 < x < 0.3 and y == z == 0, step
assert before == after
CHECK
[ "$(diff "$scratch/original.json" "$scene" | grep -c '^>')" = 1 ] || fail "more than one line of the file has changed"
check_images "after the move"

key ctrl+z
until_true 30 same_as "$scratch/original.json" || fail "the move was not undone"

drag 600 300 100 -40
until_true 30 changed_from "$scratch/original.json" || fail "the orbit changed nothing"
[ "$(diff "$scratch/original.json" "$scene" | grep '^>' | grep -c '"camera"')" = 1 ] || fail "the camera was not saved"
[ "$(diff "$scratch/original.json" "$scene" | grep -c '^>')" = 1 ] || fail "the orbit changed more than the camera"
check_images "after the orbit"

cp "$scene" "$scratch/turned.json"
key ctrl+z
until_true 30 same_as "$scratch/original.json" || fail "the orbit was not undone"
click 330 480
key ctrl+d
until_true 30 changed_from "$scratch/original.json" || fail "no copy was made"
[ "$(grep -c '"tall box"' "$scene")" = 2 ] || fail "the copy is not one of the tall box"
key Delete
until_true 30 same_as "$scratch/original.json" || fail "the copy was not deleted"

# Another program writes the file: a broken one is reported, a good one is shown.
echo '{"camera": ' >"$scene"
sleep 2
key F12
kill -0 $process || fail "a broken file ended the window"
cp "$scratch/turned.json" "$scene"
check_images "after another program has changed the file"
[ -s "$scratch/view.png" ] || fail "F12 wrote no view.png"

# A point light has a marker at (224, 294) and an arrow along x to the right of it.
python3 - "$scratch/original.json" "$scene" <<'ADD'
import json, sys
scene = json.load(open(sys.argv[1]))
scene["lights"] = [{"type": "point", "position": [-0.5, 1.3, 0.2], "intensity": 0.3}]
json.dump(scene, open(sys.argv[2], "w"), indent=1)
ADD
cp "$scene" "$scratch/lit.json"
check_images "with a light"
click 224 294
drag 300 294 60 0
until_true 30 changed_from "$scratch/lit.json" || fail "moving the light changed nothing"
python3 - "$scratch/lit.json" "$scene" <<'CHECK' || fail "the light was not moved along x alone"
import json, sys
before, after = (json.load(open(path)) for path in sys.argv[1:])
x, y, z = after["lights"][0]["position"]
assert -0.4 < x < -0.2 and [y, z] == [1.3, 0.2], (x, y, z)
after["lights"][0]["position"] = before["lights"][0]["position"]
assert before == after
CHECK
check_images "after the light has moved"

key ctrl+q
code=0
wait $process || code=$?
[ "$code" -eq 0 ] || fail "exit code $code"
[ -s "$scratch/view.txt" ] && fail "$(cat "$scratch/view.txt")"
finish
