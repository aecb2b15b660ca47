# What `cmake --install` installs: programs, models, a CMake package that another project builds with, manual pages and
# completion; and the launchers of the Debian package.
. tests/cli/support.sh
build=$(dirname "$bin")
prefix=$scratch/prefix
models=$prefix/share/duet/models
expect 0 cmake --install "$build" --prefix "$prefix"

# The consumer is compiled by the compiler of the build, as the libraries may need its runtime (sanitizers).
compiler=$(sed -n 's/^CMAKE_CXX_COMPILER:[A-Z]*=//p' "$build/CMakeCache.txt")
expect 0 cmake -G Ninja -S tests/consumer -B "$scratch/consumer" -DCMAKE_PREFIX_PATH="$prefix" \
    -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_BUILD_TYPE=Release
expect 0 cmake --build "$scratch/consumer"
expect 0 "$scratch/consumer/render_both" "$models/meshes/pear.obj" "$scratch/raster.png" "$scratch/raytrace.png"
expect 0 "$prefix/bin/compare" images "$scratch/raster.png" "$scratch/raytrace.png" --fail-above flip=0.06
size=$(od -An -tu1 -j16 -N8 "$scratch/raster.png" | tr -s ' ') # in the header of a PNG file
[ "$size" = ' 0 0 0 160 0 0 0 120' ] || fail "the consumer's image has another size: $size"
# A scene that is built in code, with a shader of its own.
expect 0 "$scratch/consumer/own_scene" "$scratch/raster.png" "$scratch/raytrace.png" "$scratch/bands.png"
expect 0 "$prefix/bin/compare" images "$scratch/raster.png" "$scratch/raytrace.png" --fail-above flip=0.14
expect 1 "$prefix/bin/compare" images "$scratch/raster.png" "$scratch/bands.png" --fail-above flip=0.14
expect 1 "$scratch/consumer/render_both" "$scratch/none.obj" "$scratch/a.png" "$scratch/b.png"
one_line_error "none.obj"

# Installed scenes find their meshes and textures, the generated ones too.
for scene in amphora hall maps; do
    expect 0 "$prefix/bin/raster" "$models/$scene.json" --size 32x24 --quiet --no-indirect -o "$scratch/$scene.png"
done

# Each option of the help is in the manual page, and in the completion.
for program in raster raytrace compare; do
    "$bin/$program" --help | sed -n 's/^  \(--[a-z-]*\).*/\1/p' >"$scratch/options"
    gzip -dc "$prefix/share/man/man1/$program.1.gz" | sed 's/\\-/-/g' >"$scratch/manual"
    while read -r option; do
        grep -q -e "^\.B $option" "$scratch/manual" || fail "the manual page of $program lacks $option"
    done <"$scratch/options"
done
grep -q '^\.B --dither,--no-dither$' "$scratch/manual" || fail "the manual page of compare joins an option and its text"
grep -q 'COMPARE LADDER' "$scratch/manual" || fail "the manual page of compare lacks its subcommand ladder"

# complete WORD…: what bash offers for the last word.
complete() {
    PATH="$prefix/bin:$PATH" bash -c '. "$0"; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1))
        _duet "$1" "${COMP_WORDS[COMP_CWORD]}"; echo "${COMPREPLY[@]}"' \
        "$prefix/share/bash-completion/completions/compare" "$@"
}
[ "$(complete compare la)" = ladder ] || fail "compare la is completed to: $(complete compare la)"
[ "$(complete compare run --raster)" = --raster-spp ] || fail "compare run --raster: $(complete compare run --raster)"
[ "$(complete raster --no-f)" = --no-fog ] || fail "raster --no-f is completed to: $(complete raster --no-f)"
[ -z "$(complete raster models/de)" ] || fail "a file name is completed to: $(complete raster models/de)"

# A launcher starts the program of its name and of the CPU's level, or of DUET_LEVEL. Scripts stand for the programs.
package=$scratch/package
expect 0 cmake --install "$build" --prefix "$package" --component launchers
for level in x86-64-v2 x86-64-v3 x86-64-v4; do
    mkdir -p "$package/lib/duet/$level"
    printf '#!/bin/sh\necho "%s $# $2"\nexit 7\n' $level >"$package/lib/duet/$level/raytrace"
    chmod +x "$package/lib/duet/$level/raytrace"
    expect 7 env DUET_LEVEL=$level "$package/bin/raytrace" a 'b c'
    [ "$(cat "$scratch/stdout")" = "$level 2 b c" ] || fail "the launcher started: $(cat "$scratch/stdout")"
done
best=x86-64-v2
! grep -q '^flags.*fma.*avx2.*bmi2' /proc/cpuinfo || best=x86-64-v3
! grep -q '^flags.*avx512f.*avx512dq.*avx512cd.*avx512bw.*avx512vl' /proc/cpuinfo || best=x86-64-v4
expect 7 env -u DUET_LEVEL "$package/bin/raytrace" a
[ "$(cat "$scratch/stdout")" = "$best 1 " ] || fail "this CPU has $best; the launcher started: $(cat "$scratch/stdout")"
ln -s "$package/bin/raytrace" "$scratch/link"
expect 7 "$scratch/link" a
expect 1 env DUET_LEVEL=x86-64-v3 "$package/bin/raster"
one_line_error "x86-64-v3/raster: No such file or directory"
one_line_error "Set DUET_LEVEL to x86-64-v2, -v3 or -v4"
expect 1 env -u DUET_LEVEL "$package/bin/raster"
one_line_error "Reinstall the package"
expect 2 env DUET_LEVEL= "$package/bin/raster"
one_line_error "lacks SSE4.2"
gzip -dc "$package/share/doc/duet/changelog.gz" | grep -q '^duet (' || fail "the changelog lacks the package's name"
grep -q 'BSD-3-clause' "$package/share/doc/duet/copyright" || fail "copyright lacks the libraries' licenses"
finish
