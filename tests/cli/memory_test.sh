#!/bin/sh
# An image that needs more memory than there is gives one line and exit code 1, and statistics name the peak.
. "$(dirname "$0")/support.sh"

limited() { # limited COMMAND…: the program may hold 1.5 GB
    (
        ulimit -v 1500000
        "$@"
    )
}
for program in raster raytrace; do
    if limited "$bin/$program" --version >"$scratch/stdout" 2>&1; then # the address sanitizer cannot start so
        expect 1 limited "$bin/$program" models/cornell.json -o "$scratch/a.ppm" --size 16384x16384 --spp 1 --quiet
        one_line_error "$program: not enough memory for this image and scene"
        [ ! -e "$scratch/a.ppm" ] || fail "$program left a file"
    fi
    expect 0 "$bin/$program" models/cornell.json -o "$scratch/small.ppm" --size 24x16 --spp 1 --quiet --stats -
    peak=$(sed -n 's/.*"peak_memory_bytes": \([0-9]*\).*/\1/p' "$scratch/stdout")
    [ "$peak" -gt 5000000 ] && [ "$peak" -lt 10000000000 ] || fail "$program: a peak of $peak bytes"
done
finish
