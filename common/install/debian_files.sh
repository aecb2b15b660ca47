#!/bin/sh
# Writes two files that every Debian package has: copyright, with the licenses of the libraries that are compiled into
# the programs, and changelog.gz, which names the page that has the changes.
# usage: debian_files.sh FOLDER VERSION MAINTAINER
set -eu
cd "$(dirname "$0")/../.."
{
    cat LICENSE
    for package in nlohmann-json3-dev libcli11-dev libxsimd-dev libstb-dev libimgui-dev; do
        [ -f /usr/share/doc/$package/copyright ] || continue # Dear ImGui is optional
        printf '\n\nThe programs contain code of the package %s:\n\n' $package
        cat /usr/share/doc/$package/copyright
    done
} >"$1/copyright"
day=$(sed -n '/^## /{s///;p;q}' common/changes.md)
gzip -9n >"$1/changelog.gz" <<END
duet ($2) unstable; urgency=medium

  * See common/changes.md in this folder.

 -- $3  $(date -R -u -d "$day")
END
