#!/bin/sh
# Truncated, malformed and hostile inputs give one clear line and exit code 2, from each program, and write nothing.
. "$(dirname "$0")/support.sh"

in=$scratch/in
mkdir -p "$in"
quad='{"type": "quad", "corner": [0,0,0], "u": [1,0,0], "v": [0,1,0], "material": "m"}'
scene() { # scene FILE MATERIALS OBJECTS [MORE]
    printf '{"camera": {"eye": [0,0,5], "look_at": [0,0,0]}, "materials": {"m": %s}, "objects": [%s]%s}' "$2" "$3" \
        "${4:-}" >"$in/$1"
}
plain='{"type": "diffuse", "albedo": 0.5}'
mesh() { printf '{"type": "mesh", "file": "%s", "material": "m"}' "$1"; }

scene good.json "$plain" "$quad"
expect 0 "$bin/raster" "$in/good.json" -o "$scratch/good.png" --size 8x8 --quiet

refuse() { # refuse FILE TEXT
    for program in raster raytrace; do
        rm -f "$scratch/out.png"
        expect 2 timeout 60 "$bin/$program" "$in/$1" -o "$scratch/out.png" --size 8x8 --quiet
        one_line_error "$2"
        [ ! -e "$scratch/out.png" ] || fail "$program $1: an image was written"
    done
    expect 2 timeout 60 "$bin/compare" run "$in/$1" -o "$scratch/report" --size 8x8 --quiet
    one_line_error "$2"
}

refuse missing.json 'no such file'
printf '' >"$in/empty.json"; refuse empty.json 'unexpected end of input'
printf '{"camera": {' >"$in/truncated.json"; refuse truncated.json 'line 1, column 13'
printf '[1, 2, 3]' >"$in/array.json"; refuse array.json 'expected an object'
head -c 100000 /dev/zero | tr '\0' '[' >"$in/deep.json"; refuse deep.json 'nested more than'
printf '\001\377{\200[[\000\012' >"$in/noise.json"; refuse noise.json 'syntax error'

scene albedo.json '{"type": "diffuse", "albedo": "red"}' "$quad"; refuse albedo.json materials.m.albedo
scene overflow.json '{"type": "diffuse", "albedo": 1e999}' "$quad"; refuse overflow.json overflow.json
scene unknown.json '{"type": "diffuse", "albdeo": 1}' "$quad"; refuse unknown.json albdeo
scene kind.json '{"type": "velvet"}' "$quad"; refuse kind.json velvet
scene nomaterial.json "$plain" '{"type": "sphere", "center": [0,0,0], "radius": 1, "material": "missing"}'; refuse \
    nomaterial.json missing
scene radius.json "$plain" '{"type": "sphere", "center": [0,0,0], "radius": -1, "material": "m"}'; refuse radius.json \
    objects[0].radius
scene cycle.json "$plain" '{"type": "group", "name": "a", "objects": [{"type": "instance", "of": "a"}]}'
refuse cycle.json 'is part of itself'
scene size.json "$plain" "$quad" ', "image": {"width": 1000000, "height": 10}'; refuse size.json image.width
scene nomesh.json "$plain" "$(mesh missing.obj)"; refuse nomesh.json missing.obj

scene noobj.json "$plain" "$(mesh bad.obj)"
bad_obj() { # bad_obj CONTENTS TEXT: as a mesh of a scene
    printf "$1" >"$in/bad.obj"
    refuse noobj.json "$2"
}
bad_obj 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n' 'line 4: the vertex index 9 is out of range'
bad_obj 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9\n' 'line 4: the vertex index -9 is out of range'
bad_obj 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n' 'line 4: the vertex index 0 is out of range'
bad_obj 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n' \
    'line 4: the vertex index 99999999999999999999 is out of range'
bad_obj 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/5 2/6 3/7\n' 'texture coordinate index'
bad_obj 'v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n' 'line 2: found "nan"'
bad_obj 'v 0 0 0\nv 1e30 0 0\nv 0 1e30 0\nf 1 2 3\n' 'line 2: found "1e30"'
bad_obj 'v 0 0 0\nv 1 0 0\nv 0 1 0\n' 'no faces'
bad_obj '' 'no faces'
bad_obj 'hello\n' 'no faces'

# Pictures as textures.
scene texture.json '{"type": "diffuse", "albedo": {"texture": "t"}}' "$quad" \
    ', "textures": {"t": {"type": "image", "file": "bad.png"}}'
printf '\211PNG\r\n\032\n\000\000\000\015IHDR\000\001\206\240\000\001\206\240\010\002\000\000\000' >"$in/bad.png"
refuse texture.json 'truncated' # claims 100,000 x 100,000
printf '\211PNG\r\n\032\n' >"$in/bad.png"; refuse texture.json 'truncated'
printf 'P6 100000 100000 255\n' >"$in/bad.png"; refuse texture.json '100000 x 100000 pixels'
printf 'PF\n30000 30000\n-1.0\n' >"$in/bad.png"; refuse texture.json '30000 x 30000 pixels'
printf '' >"$in/bad.png"; refuse texture.json 'empty file'
rm "$in/bad.png"; refuse texture.json bad.png
mkdir "$in/bad.png"; refuse texture.json bad.png

# Arguments.
for program in raster raytrace; do
    expect 2 "$bin/$program"; one_line_error "$program:"
    expect 2 "$bin/$program" "$in/good.json" -o "$scratch/x.gif"; one_line_error x.gif
    expect 2 "$bin/$program" "$in/good.json" -o "$scratch/x.png" --size 0x5; one_line_error --size
    expect 2 "$bin/$program" "$in/good.json" -o "$scratch/x.png" --size 5; one_line_error --size
    expect 2 "$bin/$program" "$in/good.json" -o "$scratch/x.png" --spp 0; one_line_error --spp
    for seed in -1 ' -1' 0x10 99999999999999999999; do
        expect 2 "$bin/$program" "$in/good.json" -o "$scratch/x.png" --seed "$seed"; one_line_error \
            "found $seed, expected a whole number"
    done
    expect 2 "$bin/$program" "$in/good.json" -o "$scratch/x.png" --aov colour; one_line_error colour
    expect 2 "$bin/$program" "$in/good.json" -o "$scratch/x.png" --colour; one_line_error --colour
    expect 2 "$bin/$program" "$in/good.json" -o "$scratch/no/folder/x.png"; one_line_error folder
    expect 0 "$bin/$program" --help
    grep -q -- --spp "$scratch/stdout" || fail "$program --help does not name --spp"
done
expect 2 "$bin/raytrace" "$in/good.json" -o "$scratch/x.png" --integrator magic; one_line_error magic
expect 2 "$bin/raytrace" "$in/good.json" -o "$scratch/x.png" --sampler magic; one_line_error magic
expect 2 "$bin/raster" "$in/good.json" -o "$scratch/x.png" --shading magic; one_line_error magic
for number in nan inf -1; do
    expect 2 "$bin/compare" stress --list --trials $number; one_line_error \
        "--trials: found $number, expected a number from"
    expect 2 "$bin/compare" kernels "$in/good.json" --seconds $number; one_line_error \
        "--seconds: found $number, expected seconds from"
    expect 2 "$bin/compare" skip "$in/good.json" --budget $number; one_line_error \
        "--budget: found $number, expected a number from"
    expect 2 "$bin/compare" bench "$in/good.json" --drift $number; one_line_error \
        "--drift: found $number, expected a number from"
done
for number in nan inf -1 far; do
    expect 2 "$bin/raster" "$in/good.json" -o "$scratch/x.png" --occlusion-radius $number
    one_line_error "--occlusion-radius: found $number, expected a finite number of at least 0"
    expect 2 "$bin/raytrace" "$in/good.json" -o "$scratch/x.png" --time $number
    one_line_error "--time: found $number, expected a finite number above 0"
done
finish
