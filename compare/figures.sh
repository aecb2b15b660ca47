#!/bin/sh
# Measures the figures of all pages, or those named, and writes them into the pages. `--help` lists the options.
# usage: sh compare/figures.sh [NAME…]
set -eu
exec python3 -B "$(dirname "$0")/figures/renew.py" "$@"
