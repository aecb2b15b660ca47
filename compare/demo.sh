#!/bin/sh
# Installs what is missing, builds the three programs, renders a mesh scene with both pipelines and says where the
# report is.
# usage: sh compare/demo.sh [SCENE [ARGUMENTS OF compare run…]]
set -eu
here=$PWD
cd "$(dirname "$0")/.."
scene=${1:-$PWD/models/demo.json}
[ $# -gt 0 ] && shift
case $scene in /*) ;; *) scene=$here/$scene ;; esac
sh common/setup.sh release
cmake --build --preset release --target raster raytrace compare models
out="out/$(basename "${scene%.*}")"
mkdir -p "$out"
build/release/bin/compare run "$scene" -o "$out" "$@"
echo
echo "The report: $PWD/$out/index.html (open it in a browser)"
