#!/bin/sh
# Output that can't be written gives one line with the system's reason and exit code 1, and damages nothing: a file of
# that name stays as it was, and no half-written file stays beside it. A limit on the size of files stands for a full
# disk, because it needs no rights.
. "$(dirname "$0")/support.sh"

out=$scratch/out
mkdir -p "$out"
limited() { # limited COMMAND…: no file may grow beyond 8 KiB, and no signal says so
    (
        trap '' XFSZ
        ulimit -f 16
        "$@"
    )
}
unchanged() { # unchanged FILE: the folder holds the old file, and nothing else
    [ "$(ls -A "$out")" = "$1" ] || fail "the folder holds $(ls -A "$out"), expected $1"
    [ "$(cat "$out/$1")" = old ] || fail "$1 has changed"
}

for format in png tga ppm pfm hdr exr; do
    rm -rf "${out:?}"/*
    echo old >"$out/x.$format"
    expect 1 limited "$bin/raster" models/cornell.json -o "$out/x.$format" --size 300x300 --quiet
    one_line_error "x.$format: cannot be written: "
    unchanged "x.$format"
done

# A film that was complete stays complete.
rm -rf "${out:?}"/*
"$bin/raytrace" models/cornell.json -o "$scratch/a.png" --size 100x100 --spp 1 --quiet --film "$out/film.exr"
cp "$out/film.exr" "$scratch/before.exr"
expect 1 limited "$bin/raytrace" models/cornell.json -o "$scratch/a.png" --size 100x100 --spp 2 --quiet \
    --film "$out/film.exr"
one_line_error "film.exr: cannot be written"
cmp "$out/film.exr" "$scratch/before.exr" || fail "a film has changed"
[ "$(ls -A "$out")" = film.exr ] || fail "the folder holds $(ls -A "$out"), expected film.exr"

# Folders that can't be.
expect 1 "$bin/compare" run models/cornell.json -o "$scratch/a.png/report" --size 8x8 --quiet
one_line_error "a.png/report: the folder cannot be made: "
expect 1 "$bin/raster" models/cornell.json -o /proc/x.png --size 8x8 --quiet
one_line_error "/proc/x.png: cannot be written: "
finish
