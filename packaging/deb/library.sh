#!/usr/bin/env bash
# Builds the packages libsoftgrip0 (the shared library) and libsoftgrip-dev (headers, CMake and pkg-config
# files, examples): library.sh SOURCE BUILD CHANGELOG.gz VERSION OUT_DIR prints their paths.
set -euo pipefail
source=$1 build=$2 changelog=$3 version=$4 out=$5
. "$source/packaging/deb/tree.sh"

work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
architecture=$(dpkg --print-architecture)
DESTDIR=$work/dev cmake --install "$build" --component library --prefix /usr --strip >&2
folder=usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)

install -d "$work/run/$folder" "$work/run/DEBIAN"
mv "$work/dev/$folder"/libsoftgrip.so.* "$work/run/$folder"
libraries=$(libraries_of "$work/run/$folder/libsoftgrip.so.0")
# Before version 1.0.0, each minor version may change the interface. Packages that use the library therefore depend on
# this minor version or a later one.
echo "libsoftgrip 0 libsoftgrip0 (>= ${version%%[+-]*})" >"$work/run/DEBIAN/shlibs"
echo "activate-noawait ldconfig" >"$work/run/DEBIAN/triggers"
packed "$work/run" libsoftgrip0 "$architecture"

examples=$work/dev/usr/share/doc/libsoftgrip-dev/examples
install -d "$examples"
install -m 644 "$source"/examples/cpp/* "$examples"
packed "$work/dev" libsoftgrip-dev "$architecture"
