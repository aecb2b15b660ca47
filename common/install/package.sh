#!/bin/sh
# Builds the programs for x86-64-v2, -v3 and -v4, and from all a Debian package: build/duet_VERSION_amd64.deb.
# Programs that compute tables run during the build, so the CPU must have AVX-512. Like setup.sh, it installs what is
# missing.
# usage: sh common/install/package.sh
set -eu
cd "$(dirname "$0")/../.."
if ! grep -q avx512vl /proc/cpuinfo; then
    echo "package: this CPU lacks AVX-512, which the build of x86-64-v4 needs. Build on one that has it" >&2
    exit 1
fi
for preset in package-v4 package-v3 package-v2; do
    sh common/setup.sh $preset dpkg-dev
    cmake --build --preset $preset
done
cd build
cpack --config package-v3/CPackConfig.cmake
