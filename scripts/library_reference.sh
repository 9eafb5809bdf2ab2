#!/usr/bin/env bash
# Builds the reference of the public C++ headers with Doxygen. A warning counts as an error:
# scripts/library_reference.sh [OUT_DIR] OUT_DIR: default build/reference. Prints the path of its first page.
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
out=$(realpath -m "${1:-build/reference}")
version=$(sed -n 's/^project(softgrip VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
mkdir -p "$out"
sed -e "s|@SOURCE@|$PWD|g" -e "s|@OUT@|$out|" -e "s|@VERSION@|$version|" library/Doxyfile.in >"$out/Doxyfile"
if ! doxygen "$out/Doxyfile" >"$out/doxygen.log" 2>&1; then
  cat "$out/doxygen.log" >&2
  exit 1
fi
echo "$out/html/index.html"
