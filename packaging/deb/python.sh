#!/usr/bin/env bash
# The package python3-softgrip: python.sh SOURCE CHANGELOG.gz VERSION OUT_DIR prints its path.
set -euo pipefail
source=$1 changelog=$2 version=$3 out=$4

tree=$(mktemp -d) && trap 'rm -rf "$tree"' EXIT
doc=$tree/usr/share/doc/python3-softgrip
install -d "$tree/DEBIAN" "$tree/usr/lib/python3/dist-packages/softgrip" "$doc/examples"
install -m 644 "$source"/python/softgrip/*.py "$source/python/softgrip/py.typed" \
  "$tree/usr/lib/python3/dist-packages/softgrip"
install -m 644 "$source"/python/examples/*.py "$doc/examples"
install -m 644 "$source/packaging/deb/copyright" "$doc/copyright"
gunzip -c "$changelog" | sed '1s/^softgrip/python3-softgrip/' | gzip -9n >"$doc/changelog.Debian.gz"
install -d "$tree/usr/share/lintian/overrides"
sed 's/^softgrip:/python3-softgrip:/' "$source/packaging/deb/lintian-overrides" \
  >"$tree/usr/share/lintian/overrides/python3-softgrip"
sed "s/@VERSION@/$version/" "$source/packaging/deb/python3-softgrip.control" >"$tree/DEBIAN/control"
(cd "$tree" && find usr -type f -print0 | sort -z | xargs -0 md5sum >DEBIAN/md5sums)
chmod -R u=rwX,go=rX "$tree"
package=$out/python3-softgrip_${version}_all.deb
dpkg-deb --root-owner-group --build "$tree" "$package" >&2
echo "$package"
