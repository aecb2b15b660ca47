#!/bin/sh
# Runs before the Debian package is installed and after it is removed. Debian's bash-completion has a completion of
# ImageMagick's compare at the path of ours: it is renamed for as long as the package is installed.
set -e
case $1 in
    install)
        dpkg-divert --package duet --add --rename \
            --divert /usr/share/bash-completion/completions/compare.imagemagick \
            /usr/share/bash-completion/completions/compare
        ;;
    remove | abort-install | disappear)
        dpkg-divert --package duet --remove --rename \
            --divert /usr/share/bash-completion/completions/compare.imagemagick \
            /usr/share/bash-completion/completions/compare
        ;;
esac
