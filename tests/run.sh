#!/bin/sh
# Installs what is missing, builds, and runs all tests.
# usage: sh tests/run.sh [PRESET [CTEST ARGUMENTS…]]        (default: release)
# e.g.   sh tests/run.sh release -L unit
set -eu
cd "$(dirname "$0")/.."
preset=${1:-release}
[ $# -gt 0 ] && shift
# The browser tests need Python and a Chromium. Debian has one as a package; Ubuntu's is a stub for a snap, so there one
# that is installed (Chromium or Chrome) is taken, and without one the tests are skipped.
# Embree is a peer of `compare kernels`, whose tests want it; the programs build without.
# The course's pages are checked by KaTeX (formulas) and hunspell (spelling), the comments of functions by Doxygen.
# git knows which files are the project's, and applies the mutations. OpenVDB's Python module
# reads files of clouds and smoke (models/vdb_to_smoke.py).
# The window is tested on a virtual screen (Xvfb), drawn by Mesa's software renderer, with a mouse of xdotool.
packages='git libembree-dev katex hunspell hunspell-en-us doxygen xvfb xdotool libgl1-mesa-dri'
command -v python3 >/dev/null || packages="$packages python3"
if grep -q '^ID=debian' /etc/os-release; then
    packages="$packages python3-openvdb"
    python3 -B tests/browser/chromium.py >/dev/null 2>&1 || packages="$packages chromium"
fi
# The sanitizers' build is Clang's, so that two compilers read the code.
[ "$preset" != asan ] || packages="$packages clang libclang-rt-dev"
sh common/setup.sh "$preset" $packages
cmake --build --preset "$preset"
case $preset in
    asan | tsan) ;; # the course's programs are tested as students build them
    *) cmake --build --preset "$preset" --target lessons judges ;;
esac
exec ctest --preset "$preset" "$@"
