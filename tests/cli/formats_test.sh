#!/bin/sh
# Each image format is written, statistics have the promised keys, an orbit its frames.
. "$(dirname "$0")/support.sh"

for program in raster raytrace; do
    cheap=''
    [ $program = raytrace ] || cheap='--shading normal' # the files are tested, not the images
    rm -f "$scratch"/a.*
    for ending in png jpg tga ppm pfm hdr exr; do
        expect 0 "$bin/$program" models/cornell.json -o "$scratch/a.$ending" --size 24x16 --spp 2 --quiet $cheap
        [ -s "$scratch/a.$ending" ] || fail "$program wrote no .$ending"
    done
    expect 0 "$bin/$program" models/cornell.json -o "$scratch/a.ppm" --ascii --size 24x16 --spp 2 --quiet $cheap
    head -c 2 "$scratch/a.ppm" | grep -q P3 || fail "--ascii wrote no P3"
    expect 0 "$bin/$program" models/cornell.json -o "$scratch/a.png" --size 24x16 --spp 2 --quiet --stats - --aov \
        depth,hit
    [ -s "$scratch/a.depth.exr" ] && [ -s "$scratch/a.hit.exr" ] || fail "$program: --aov wrote no files beside the PNG"
    for key in program version scene width height threads samples_per_pixel passes seed seconds load prepare render \
        write total \
        rays camera indirect shadow triangles memory_bytes peak_memory_bytes bvh estimated_relmse invalid_samples \
        first_invalid approximations skipped; do
        grep -q "\"$key\":" "$scratch/stdout" || fail "$program --stats lacks $key"
    done
    expect 0 "$bin/$program" models/cornell.json -o "$scratch/orbit-%04d.png" --orbit 3 --size 24x16 --spp 2 --quiet \
        $cheap
    for frame in 0000 0001 0002; do
        [ -s "$scratch/orbit-$frame.png" ] || fail "$program --orbit wrote no frame $frame"
    done
    ! cmp -s "$scratch/orbit-0000.png" "$scratch/orbit-0001.png" || fail "$program --orbit does not turn the camera"
    rm -f "$scratch"/orbit*
    expect 2 "$bin/$program" models/cornell.json -o "$scratch/turn.mp4" --size 24x16
    one_line_error "a video needs --orbit"
    code=1
    ! command -v ffmpeg >"$scratch/ffmpeg" || code=0
    expect $code "$bin/$program" models/cornell.json -o "$scratch/turn.mp4" --orbit 3 --size 25x17 --spp 2 --quiet \
        $cheap
    if [ $code = 0 ]; then # the video is there and the frames are gone, or the other way round
        [ -s "$scratch/turn.mp4" ] && [ ! -e "$scratch/turn-0000.png" ] || fail "$program wrote no video"
    else
        [ ! -e "$scratch/turn.mp4" ] && [ -s "$scratch/turn-0002.png" ] || fail "$program left no frames"
    fi

    # Exposure, tone and dithering change 8-bit files; the command line overrides the scene; floats stay as they are.
    rm -f "$scratch/sums"
    for view in '' '--exposure 1' '--tone filmic' '--tone agx' '--tone agx --dither'; do
        expect 0 "$bin/$program" models/cornell.json -o "$scratch/view.ppm" --size 24x16 --spp 2 --quiet $cheap $view
        cksum <"$scratch/view.ppm" >>"$scratch/sums"
    done
    [ "$(sort -u "$scratch/sums" | wc -l)" = 5 ] || fail "$program: two view transforms gave the same file"
    sed "s#\"image\": {#&\"tone\": \"agx\", \"exposure\": 2, #; s#\"meshes/#\"$PWD/models/meshes/#" \
        models/cornell.json >"$scratch/view.json"
    expect 0 "$bin/$program" "$scratch/view.json" -o "$scratch/view.ppm" --size 24x16 --spp 2 --quiet $cheap \
        --tone none --exposure 1
    [ "$(cksum <"$scratch/view.ppm")" = "$(sed -n 2p "$scratch/sums")" ] || fail "$program: --tone is not the last word"
    expect 0 "$bin/$program" models/cornell.json -o "$scratch/plain.pfm" --size 24x16 --spp 2 --quiet $cheap
    expect 0 "$bin/$program" models/cornell.json -o "$scratch/view.pfm" --size 24x16 --spp 2 --quiet $cheap --tone agx
    cmp -s "$scratch/plain.pfm" "$scratch/view.pfm" || fail "$program: --tone changed linear values"
    expect 2 "$bin/$program" models/cornell.json -o "$scratch/view.png" --tone warm
    one_line_error 'tone: found "warm"; expected one of "none", "filmic", "agx"'
    expect 2 "$bin/$program" models/cornell.json -o "$scratch/view.png" --exposure nan
    one_line_error "expected a number of stops in"
done
finish
