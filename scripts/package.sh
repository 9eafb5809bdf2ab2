#!/usr/bin/env bash
# Builds the four Debian packages softgrip, libsoftgrip0, libsoftgrip-dev and python3-softgrip, and checks
# them with lintian: scripts/package.sh [OUT_DIR [REVISION]]. OUT_DIR: default build/. The last line of the
# output is the path of the first package. The script builds in build/release, like scripts/test.sh.
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
out=$(realpath -m "${1:-build}")
revision=${2:-1}

bash scripts/packages.sh build package
cmake --preset release -DSOFTGRIP_PACKAGE_RELEASE="$revision" \
  -DCMAKE_INSTALL_LIBDIR="lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)" >/dev/null
. scripts/build.sh
build release softgripd softgrip softgrip-rig softgrip-plc softgrip-web libsoftgrip softgrip_python man_pages completions
mkdir -p "$out"
log=$(mktemp) && trap 'rm -f "$log"' EXIT
(cd build/release && cpack -B "$out" >"$log" 2>&1) || { cat "$log" >&2; exit 1; }
rm -rf "$out/_CPack_Packages"
package=$(ls -t "$out"/softgrip_*-"$revision"_*.deb | head -n 1)
changelog=build/release/packaging/changelog.Debian.gz
version=$(dpkg-deb -f "$package" Version)
mapfile -t libraries < <(bash packaging/deb/library.sh . build/release "$changelog" "$version" "$out")
[ ${#libraries[@]} -eq 2 ] || { echo "package.sh: the packages of the library are missing" >&2; exit 1; }
python=$(bash packaging/deb/python.sh . build/release "$changelog" "$version" "$out")
lintian --fail-on warning,error "$package" "${libraries[@]}" "$python"
echo "$package"
