#!/bin/sh
# Films: whatever kills the program, the next run goes on to the same bits; shards join to the image of one run.
. "$(dirname "$0")/support.sh"

render() {
    out=$1
    shift
    "$bin/raytrace" models/cornell.json -o "$scratch/$out" --size 64x64 --quiet "$@"
}
# Starts a render and sets $process to its own id; `render … &` would give a shell's.
start() {
    out=$1
    shift
    "$bin/raytrace" models/cornell.json -o "$scratch/$out" --size 64x64 --quiet "$@" &
    process=$!
}

render whole.pfm --spp 48
render long.pfm --spp 1000

# Killed again and again, with no time to say goodbye.
for delay in 0.1 0.2 0.3; do
    start killed.pfm --spp 1000 --threads 1 --film "$scratch/kept.exr" --film-interval 0
    sleep "$delay"
    kill -9 $process || fail "the render ended by itself"
    wait $process 2>/dev/null || true
done
render killed.pfm --spp 1000 --film "$scratch/kept.exr"
cmp "$scratch/long.pfm" "$scratch/killed.pfm" || fail "a killed render that went on from its film has other bits"

# What a killed render leaves of a film is removed by the next one, and nothing else is.
touch "$scratch/.kept.123.exr" "$scratch/.kept.1x3.exr" "$scratch/.kept.123.pfm"
render killed.pfm --spp 1000 --film "$scratch/kept.exr"
[ "$(cd "$scratch" && echo .kept.*)" = ".kept.123.pfm .kept.1x3.exr" ] ||
    fail "beside the film are $(cd "$scratch" && echo .kept.*)"

# Two processes on one film: the second one refuses.
start first.pfm --spp 1000000 --film "$scratch/shared.exr"
while kill -0 $process && [ ! -e "$scratch/shared.exr.lock" ]; do sleep 0.05; done
expect 2 render second.pfm --spp 48 --film "$scratch/shared.exr"
one_line_error "shared.exr: another process works on it"
ln -s . "$scratch/alias" # the same film by another name
expect 2 render third.pfm --spp 48 --film "$scratch/alias/shared.exr"
one_line_error "alias/shared.exr: another process works on it"
kill -TERM $process
wait $process || true
[ ! -e "$scratch/shared.exr.lock" ] || fail "a render that ended left its lock"

# Interrupted: what it has is in the film, however long the interval.
terminated 1 "$bin/raytrace" models/cornell.json -o "$scratch/stopped.pfm" --size 64x64 --quiet --spp 1000000 \
    --film "$scratch/stopped.exr" --film-interval 10000
expect 0 "$bin/raytrace" merge -o "$scratch/again.pfm" "$scratch/stopped.exr"
cmp "$scratch/stopped.pfm" "$scratch/again.pfm" || fail \
    "the film of an interrupted render is not what the image shows"

# Shards, and the joint film, which goes on.
render a.png --samples 0:16 --film "$scratch/a.exr"
render b.png --samples 16:32 --film "$scratch/b.exr"
expect 0 "$bin/raytrace" merge -o "$scratch/joined.pfm" --film "$scratch/joint.exr" "$scratch/b.exr" "$scratch/a.exr"
grep -q "2 films, 32 samples per pixel" "$scratch/stderr" || fail "merge does not say what it joined"
render one.pfm --spp 32
"$bin/compare" images "$scratch/joined.pfm" "$scratch/one.pfm" --fail-above rmse=1e-9 >/dev/null ||
    fail "shards do not join to the image of one run"
render more.pfm --spp 48 --film "$scratch/joint.exr"
"$bin/compare" images "$scratch/more.pfm" "$scratch/whole.pfm" --fail-above rmse=1e-9 >/dev/null ||
    fail "a joint film does not go on"

# What cannot be: each says why in a line.
expect 2 render x.pfm --spp 48 --seed 3 --film "$scratch/a.exr"
one_line_error "a film of another image: seed: found 0, expected 3"
expect 2 "$bin/raytrace" merge -o "$scratch/x.pfm" "$scratch/a.exr" "$scratch/a.exr"
one_line_error "expected films that share none"
expect 2 "$bin/raytrace" merge -o "$scratch/x.pfm" --film "$scratch/x.exr" "$scratch/b.exr" "$scratch/joint.exr"
one_line_error "expected films that share none"
expect 2 "$bin/raytrace" merge -o "$scratch/x.pfm" "$scratch/joined.pfm"
one_line_error "not an EXR file"
expect 2 render x.pfm --samples 5:5
one_line_error "expected FIRST:END"
expect 2 render x.pfm --samples 0:8 --spp 8
one_line_error "cannot go with --spp"
expect 2 render x.pfm --film "$scratch/x.png"
one_line_error "expected an .exr"
expect 2 "$bin/raytrace" models/cornell.json -o "$scratch/x%04d.png" --orbit 2 --film "$scratch/x.exr"
one_line_error "cannot go with --orbit"
expect 2 render x.pfm --film "$scratch/missing/x.exr"
one_line_error "no folder"
finish

# With a limit sampling is adaptive, and knows its error; --no-adaptive and a plain number of samples are not.
kept() { tr -c '[:print:]' ' ' <"$scratch/$1" | grep -q "film\.$2 string  *${3}duet:"; }
render limited.png --error 0.05 --film "$scratch/limited.exr"
kept limited.exr adaptive yes || fail "--error is not adaptive"
kept limited.exr replicates 2 || fail "--error does not know its error"
render even.png --error 0.05 --no-adaptive --film "$scratch/even.exr"
kept even.exr adaptive no || fail "--no-adaptive is adaptive"
kept joint.exr replicates 1 || fail "a plain film has replicates"
