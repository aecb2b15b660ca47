#!/bin/sh
# Installs what is missing, builds, and runs all tests.
# usage: sh tests/run.sh [PRESET [CTEST ARGUMENTS…]]        (default: release)
# e.g.   sh tests/run.sh release -L unit
set -eu
cd "$(dirname "$0")/.."
preset=${1:-release}
[ $# -gt 0 ] && shift
sh common/setup.sh "$preset"
exec ctest --preset "$preset" "$@"
