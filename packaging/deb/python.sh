#!/usr/bin/env bash
# Builds the package python3-softgrip: python.sh SOURCE BUILD CHANGELOG.gz VERSION OUT_DIR prints its path.
set -euo pipefail
source=$1 build=$2 changelog=$3 version=$4 out=$5
. "$source/packaging/deb/tree.sh"

tree=$(mktemp -d) && trap 'rm -rf "$tree"' EXIT
package=$tree/usr/lib/python3/dist-packages/softgrip
examples=$tree/usr/share/doc/python3-softgrip/examples
DESTDIR=$tree cmake --install "$build" --component python --prefix /usr --strip >&2
install -d "$examples"
install -m 644 "$source"/python/softgrip/*.py "$source"/python/softgrip/*.pyi "$source/python/softgrip/py.typed" "$package"
install -m 644 "$source"/python/examples/*.py "$source"/examples/python/*.py "$examples"
# The module works with exactly one version of Python and exactly one version of libsoftgrip.
found=$(/usr/bin/python3 -c 'import sys; print("{0}.{1} {0}.{2}".format(*sys.version_info[:2], sys.version_info[1] + 1))')
libraries="python3 (>= ${found% *}), python3 (<< ${found#* }), libsoftgrip0 (= $version), $(libraries_of "$package"/_core.*.so "$build/library")"
packed "$tree" python3-softgrip "$(dpkg --print-architecture)"
