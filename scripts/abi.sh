#!/usr/bin/env bash
# Compares the binary interface (ABI) of libsoftgrip.so with the stored interface, library/libsoftgrip.abi:
#   scripts/abi.sh [BUILD]            exit 1: an incompatible change without a new SONAME, or a new SONAME that is not stored
#   scripts/abi.sh [BUILD] --renew    stores the interface of the build; refused for an incompatible change without a new SONAME
#   scripts/abi.sh [BUILD] --renew --unreleased    is not refused; for a SONAME of which no package has been released
# BUILD: default build/release. Exit 77: abidiff is missing, or the stored interface is for another type of processor.
# Added functions and types are compatible. A new field of a result is incompatible, because compiled programs use the old
# size. To set a new SONAME, change SOVERSION in cmake/library.cmake, library/exported.map and packages in packaging/deb.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
build=$here/build/release renew=false unreleased=false
for argument in "$@"; do
  case $argument in
    --renew) renew=true ;;
    --unreleased) unreleased=true ;;
    -*) sed -n '2,9s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
    *) build=$(realpath "$argument") ;;
  esac
done
stored=$here/library/libsoftgrip.abi library=$build/library/libsoftgrip.so
command -v abidiff abidw >/dev/null || { echo "abi.sh: abidiff is missing; install the Debian package abigail-tools" >&2; exit 77; }

describe() {
  abidw --suppr "$here/library/libsoftgrip.abignore" --exported-interfaces-only --no-corpus-path --no-comp-dir-path \
    --no-show-locs --no-elf-needed --no-parameter-names --type-id-style hash "$library" |
    # Replaces the path of the checkout, so that the stored text does not depend on the folder of the sources.
    sed -E "s#(<abi-instr .*path=')[^']*/(library/[^']*')#\1\2#"
}
soname_of() { sed -n "s/^<abi-corpus .*soname='\([^']*\)'.*/\1/p" "$1"; }
architecture_of() { sed -n "s/^<abi-corpus .*architecture='\([^']*\)'.*/\1/p" "$1"; }

work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
describe >"$work/present.abi"
[ -n "$(soname_of "$work/present.abi")" ] || { echo "abi.sh: $library has no SONAME" >&2; exit 1; }
compatible=true
if [ -e "$stored" ] && [ "$(architecture_of "$stored")" != "$(architecture_of "$work/present.abi")" ]; then
  echo "abi.sh: $stored was written on another processor architecture" >&2
  exit 77
fi
if [ ! -e "$stored" ] || [ "$(soname_of "$stored")" != "$(soname_of "$work/present.abi")" ]; then
  $renew || { echo "abi.sh: $(soname_of "$work/present.abi") is new; scripts/abi.sh --renew stores the interface of this SONAME" >&2; exit 1; }
else
  abidiff --no-added-syms "$stored" "$work/present.abi" >"$work/difference.txt" || compatible=false
fi
if ! $compatible && ! { $renew && $unreleased; }; then
  head -n 60 "$work/difference.txt" >&2
  echo "abi.sh: the interface is incompatible with $stored. Give the library a new SONAME, or keep the interface" >&2
  exit 1
fi
if $renew; then
  cp "$work/present.abi" "$stored"
  echo "$(soname_of "$stored"): stored as $stored"
else
  echo "$(soname_of "$stored"): compatible with the stored interface"
fi
