#!/bin/sh
# Denoising: the undenoised image is kept beside the denoised one, and films stay what they are.
. "$(dirname "$0")/support.sh"

render() {
    out=$1
    shift
    "$bin/raytrace" models/cornell.json -o "$scratch/$out" --size 64x64 --quiet "$@"
}

# The undenoised image is the one of a render that only estimates its error.
render plain.pfm --spp 8 --aov variance
render denoised.pfm --spp 8 --denoise
cmp "$scratch/plain.pfm" "$scratch/denoised.noisy.pfm" || fail "the undenoised image is not the plain render's"
cmp -s "$scratch/plain.pfm" "$scratch/denoised.pfm" && fail "the denoised image is the undenoised one"
[ ! -e "$scratch/plain.noisy.pfm" ] || fail "a plain render left an undenoised image"

# It has less error, at the cost of time that the statistics name.
render reference.pfm --spp 2048
"$bin/compare" images "$scratch/denoised.pfm" "$scratch/reference.pfm" --stats "$scratch/after.json" >/dev/null
"$bin/compare" images "$scratch/denoised.noisy.pfm" "$scratch/reference.pfm" --stats "$scratch/before.json" >/dev/null
python3 - "$scratch/before.json" "$scratch/after.json" <<'END' || fail "the denoised image is not better"
import json
import sys
before, after = (json.load(open(path))['relmse'] for path in sys.argv[1:])
print(f'relMSE {before:.3g} before, {after:.3g} after')
sys.exit(not after < before / 3)
END
render x.png --spp 4 --denoise --stats "$scratch/stats.json"
grep -q '"denoise"' "$scratch/stats.json" || fail "the statistics do not name the time of the denoiser"
[ -e "$scratch/x.noisy.png" ] || fail "no x.noisy.png"

# An EXR file holds the denoised image and the auxiliary images; the undenoised one is a file of its own.
render aov.exr --spp 8 --denoise --aov depth,variance
render undenoised.exr --spp 8 --aov depth,variance
tr -c '[:print:]' ' ' <"$scratch/aov.exr" | grep -q 'depth\.Z' || fail "aov.exr lacks the depth"
tr -c '[:print:]' ' ' <"$scratch/aov.noisy.exr" | grep -q 'depth\.Z' && fail "aov.noisy.exr has the depth"
"$bin/compare" images "$scratch/aov.noisy.exr" "$scratch/undenoised.exr" --fail-above rmse=0 >/dev/null ||
    fail "aov.noisy.exr is not the undenoised image"

# A film is that of the undenoised image, with and without --denoise, and can be continued and merged.
render film.pfm --spp 8 --denoise --film "$scratch/film.exr"
render other.pfm --spp 8 --aov variance --film "$scratch/other.exr"
cmp "$scratch/film.exr" "$scratch/other.exr" || fail "--denoise changes the film"
cmp "$scratch/film.pfm" "$scratch/denoised.pfm" || fail "--film changes the denoised image"
render again.pfm --spp 8 --denoise --film "$scratch/other.exr"
cmp "$scratch/again.pfm" "$scratch/denoised.pfm" || fail "a film that is complete is not denoised to the same bits"
render more.pfm --spp 20 --denoise --film "$scratch/other.exr"
render once.pfm --spp 20 --denoise
cmp "$scratch/more.pfm" "$scratch/once.pfm" || fail "a continued film is not denoised to the bits of one render"
expect 2 render x.pfm --spp 8 --film "$scratch/film.exr"
one_line_error "replicates: found 2, expected 1"

# With limits, in frames, interrupted, and with any number of threads.
render limited.pfm --error 0.05 --denoise
render timed.pfm --time 0.2 --denoise
render one.pfm --spp 8 --denoise --threads 1
cmp "$scratch/one.pfm" "$scratch/denoised.pfm" || fail "the threads change the denoised image"
"$bin/raytrace" models/cornell.json -o "$scratch/turn%04d.pfm" --size 16x16 --spp 4 --quiet --orbit 2 --denoise
[ -e "$scratch/turn0001.pfm" ] && [ -e "$scratch/turn0001.noisy.pfm" ] || fail "a frame lacks its undenoised image"
terminated 1 "$bin/raytrace" models/cornell.json -o "$scratch/stopped.pfm" --size 64x64 --quiet --spp 1000000 --denoise
[ -e "$scratch/stopped.pfm" ] && [ -e "$scratch/stopped.noisy.pfm" ] || fail "an interrupted render is not written"

# What cannot be: each says why in a line, before anything is rendered.
expect 2 render x.pfm --spp 1 --denoise
one_line_error "expected at least 2 samples"
expect 2 render a.exr --denoise --film "$scratch/a.noisy.exr"
one_line_error "is where --denoise keeps the undenoised image"
mkdir "$scratch/b.noisy.pfm"
expect 2 render b.pfm --denoise
one_line_error "b.noisy.pfm: is a folder"
[ ! -e "$scratch/b.pfm" ] || fail "half of an output was written"
finish
