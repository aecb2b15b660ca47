#!/bin/sh
# Runs one browser test. Exit code 77, for ctest: skipped, there is no Python here; where CI is set that is a failure.
# usage: tests/browser/run.sh FILE_test.py BIN SCRATCH [TEST…]
set -eu
command -v python3 >/dev/null || { echo "SKIPPED: no python3"; [ -n "${CI:-}" ] && exit 1; exit 77; }
exec python3 -B "$@"
