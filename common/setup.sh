#!/bin/sh
# Installs what Duet needs and is missing, from the system's packages (Debian 12, Ubuntu 24.04), then configures a
# preset: build/PRESET is ready for `cmake --build`. It builds nothing: a lesson or a program builds what it needs.
# Called by compare/demo.sh and tests/run.sh.
# usage: common/setup.sh [PRESET [PACKAGE…]]        (default: release; PACKAGE: a package that the caller needs besides)
set -eu
cd "$(dirname "$0")/.."
preset=${1:-release}
[ $# -gt 0 ] && shift

packages="g++ cmake ninja-build pkg-config libtbb-dev libxsimd-dev libopenexr-dev libtinyobjloader-dev libstb-dev \
    doctest-dev nlohmann-json3-dev libcli11-dev libglfw3-dev libimgui-dev libgl-dev $*"

missing=''
for package in $packages; do
    dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
done
if [ -n "$missing" ]; then
    if ! command -v apt-get >/dev/null; then
        echo "setup: no apt-get here. Install by your system's means:$missing" >&2
        exit 1
    fi
    as_root=''
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "setup: run this as root, or install sudo: missing packages:$missing" >&2
            exit 1
        fi
        as_root=sudo
    fi
    echo "setup: installing$missing"
    export DEBIAN_FRONTEND=noninteractive
    $as_root apt-get update -qq
    $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >/dev/null
fi

# A build folder is configured again, because what is installed now may not have been there the last time.
if [ -f "build/$preset/build.ninja" ]; then
    cmake "build/$preset" >/dev/null
else
    cmake --preset "$preset"
fi
