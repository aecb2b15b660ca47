#!/bin/sh
# Builds the web page of both pipelines and of the lessons into a folder, build/web if none is given. Open its
# index.html or lessons.html in a browser, or serve the folder from any web server. Like setup.sh, it installs what is
# missing.
# usage: sh compare/web/build.sh [FOLDER]
set -eu
cd "$(dirname "$0")/../.."
folder=${1:-build/web}
sh common/setup.sh release emscripten python3
export NODE_PATH="${NODE_PATH:-/usr/share/nodejs}" # other packages of Node.js don't look where Debian puts its modules

# Programs of the native build compute tables and meshes.
cmake --build --preset release --target models generated/ggx_albedo_data.cpp generated/ggx_table_data.cpp \
    generated/rough_glass_data.cpp
work=build/emscripten
[ -f $work/build.ninja ] || emcmake cmake -S compare/web -B $work -G Ninja -DCMAKE_BUILD_TYPE=Release \
    -DDUET_TABLES="$PWD/build/release/generated"
cmake --build $work
python3 -B compare/web/pack.py $work models "$folder"
echo "web: wrote $folder/index.html"
