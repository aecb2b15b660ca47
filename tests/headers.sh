#!/bin/sh
# Every header compiles alone: none relies on what another file included first. A header that another file includes
# first of all is compiled alone with that file, by the build or by this test, which compiles the others.
# usage: headers.sh COMPILER SOURCE_DIR
set -eu
compiler=$1
cd "$2"
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
rooms='common raster raytrace compare models tests'
find $rooms -name '*.h' -not -path '*/fuzz/*' | sort > "$scratch/headers"
find $rooms -name '*.h' -o -name '*.cpp' | grep -Ev '/(fuzz|assignments|grading)/' |
    xargs grep -m1 -h '^#include' | sed -n 's/^#include "\(.*\)"$/\1/p' | sort -u > "$scratch/compiled"
comm -23 "$scratch/headers" "$scratch/compiled" | xargs -P 2 -I{} sh -c '"$1" -std=c++20 -march=x86-64-v3 \
        -fsyntax-only -I. -isystem /usr/include/stb \
        -DDUET_SOURCE_DIR=\"\" -DDUET_BINARY_DIR=\"\" -DDUET_VERSION=\"\" -DDUET_MODELS=\"\" \
        -x c++ -include "$2" /dev/null ||
        { echo "$2 does not compile alone"; exit 255; }' sh "$compiler" {}
