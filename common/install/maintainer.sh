#!/bin/sh
# Runs before the Debian package is installed and after it is removed. Debian's bash-completion has a completion of
# ImageMagick's compare at the path of ours: it is renamed for as long as the package is installed.
set -e
divert() {
    completion=/usr/share/bash-completion/completions/compare
    dpkg-divert --package duet "$1" --rename --divert $completion.imagemagick $completion
}
case $1 in
    install) divert --add ;;
    remove | abort-install | disappear) divert --remove ;;
esac
