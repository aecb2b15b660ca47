#!/bin/sh
# Every header compiles alone: none relies on what another file included first. A header that its own .cpp includes
# first
# (x.cpp, x.h) was compiled alone by the build already; this test compiles the others.
# usage: headers.sh COMPILER SOURCE_DIR
set -eu
compiler=$1
cd "$2"
find common raster raytrace compare models tests -name '*.h' -not -path '*/fuzz/*' | sort | while read -r header; do
    first=$(grep -m1 '^#include' "${header%.h}.cpp" 2>/dev/null) || true
    [ "$first" = "#include \"$header\"" ] || echo "$header"
done | xargs -P 2 -I{} sh -c '"$1" -std=c++20 -march=x86-64-v3 -fsyntax-only -I. -isystem /usr/include/stb \
        -DDUET_SOURCE_DIR=\"\" -DDUET_BINARY_DIR=\"\" -DDUET_VERSION=\"\" -DDUET_MODELS=\"\" \
        -x c++ -include "$2" /dev/null ||
        { echo "$2 does not compile alone"; exit 255; }' sh "$compiler" {}
