#!/bin/sh
# Draws the pictures of gallery/ from the scenes of models/ with fixed settings. The path tracer keeps its samples in
# out/gallery: where all of them are there, another run only writes the pictures again.
# usage: sh compare/gallery.sh [FOLDER OF THE PROGRAMS]
set -eu
bin=$(cd "${1:-$(dirname "$0")/../build/release/bin}" && pwd)
cd "$(dirname "$0")/.."
work=out/gallery
mkdir -p $work gallery/materials

# trace NAME SCENE OPTIONS…: path traces a scene of models/ into $work/NAME.exr.
trace() {
    name=$1 scene=$2
    shift 2
    echo "$name"
    "$bin/raytrace" "models/$scene.json" --film "$work/$name.exr" -o "$work/$name.png" "$@"
}
# rasterize NAME SCENE OPTIONS…: rasterizes a scene of models/ into $work/NAME.exr.
rasterize() {
    name=$1 scene=$2
    shift 2
    "$bin/raster" "models/$scene.json" -o "$work/$name.exr" --spp 16 --quiet "$@"
}
# picture NAME OPTIONS…: turns $work/NAME.exr into gallery/NAME.jpg, with the options of a view transform.
picture() {
    name=$1
    shift
    "$bin/compare" join "$work/$name.exr" -o "gallery/$name.jpg" --dither "$@"
}

trace octopus gallery/octopus --spp 512 --adaptive
picture octopus
# The frames around it make a looping picture; this needs ffmpeg with libwebp. In some of them the corner of a light
# shows in the top row of pixels.
mkdir -p $work/orbit
"$bin/raster" models/gallery/orbit.json --orbit 72 --spp 16 -o "$work/orbit/%04d.png" --quiet
ffmpeg -loglevel error -y -framerate 15 -i "$work/orbit/%04d.png" -vf crop=320:178:0:2 -c:v libwebp_anim -quality 75 \
    -loop 0 gallery/orbit.webp
trace lantern gallery/lantern --spp 2048 --adaptive
picture lantern
trace menger gallery/menger --spp 220 --adaptive
picture menger --tone filmic --exposure 0.5
rasterize nave gallery/nave --shadow-map 8192
picture nave --tone filmic --exposure -0.55
trace glass-sphere gallery/glass-sphere --integrator vcm --spp 500
picture glass-sphere
trace caustics caustics --integrator vcm --spp 1600
picture caustics --tone filmic --exposure 0.5
trace smoke smoke --spp 1024 --adaptive
picture smoke
trace spheres spheres --size 960x540 --spp 700 --adaptive
picture spheres
trace cornell cornell --spp 512 --adaptive
picture cornell --tone filmic --exposure 1

# One scene, two pipelines: the left half is rasterized, the right half is path traced.
trace demo demo --size 800x450 --spp 400 --adaptive
rasterize demo-raster demo --size 800x450
"$bin/compare" join $work/demo-raster.exr $work/demo.exr --bands -o gallery/demo.png

# Lines, rasterized and path traced across one object; beside it, what differs.
trace difference balls/gold --size 640x600 --spp 512 --adaptive
rasterize difference-raster balls/gold --size 640x600
rasterize difference-lines balls/gold --size 640x600 --shading lines
"$bin/compare" images $work/difference-raster.exr $work/difference.exr -o $work/difference --quiet
"$bin/compare" join $work/difference-lines.exr $work/difference-raster.exr $work/difference.exr \
    --bands --slant 14 --gap 2 -o $work/difference-bands.png
"$bin/compare" join $work/difference-bands.png $work/difference/difference.png --gap 4 -o gallery/difference.jpg

# A scene in stages.
for shading in lines normal albedo lit; do
    rasterize amphora-$shading amphora --size 300x360 --shading $shading
done
trace amphora-direct amphora --size 300x360 --integrator direct --spp 128
trace amphora amphora --size 300x360 --spp 512 --adaptive
"$bin/compare" join $work/amphora-lines.exr $work/amphora-normal.exr $work/amphora-albedo.exr \
    $work/amphora-direct.exr $work/amphora-lit.exr $work/amphora.exr --columns 3 --gap 4 -o gallery/stages.jpg

# The rungs of the ladder, rasterized and path traced. The last needs more samples than the others.
"$bin/compare" ladder models/demo.json -o $work/ladder --size 320x180 --spp 128
trace ladder-everything demo --size 320x180 --spp 2048 --adaptive
(cd $work/ladder && "$bin/compare" join 1-hits-*.png 2-normals-*.png 2-albedo-*.png 3-direct-*.png 4-shadows-*.png \
    5-environment-*.png 6-reflections-*.png 7-everything-raster.png ../ladder-everything.png \
    --columns 4 --gap 4 -o "$OLDPWD/gallery/ladder.jpg")

# The materials, each by both pipelines, and all of them on one sheet.
sheet=""
for scene in models/balls/*.json; do
    ball=$(basename "$scene" .json)
    spp=1024
    [ "$ball" != glass-frosted ] || spp=4096
    trace "ball-$ball" "balls/$ball" --size 200x200 --spp $spp --adaptive
    "$bin/compare" join "$work/ball-$ball.exr" -o "gallery/materials/$ball.jpg"
    rasterize "ball-$ball-raster" "balls/$ball" --size 200x200
    "$bin/compare" join "$work/ball-$ball-raster.exr" -o "gallery/materials/$ball-raster.jpg"
    sheet="$sheet gallery/materials/$ball.jpg"
done
"$bin/compare" join $sheet --columns 4 --gap 4 -o gallery/materials.jpg
