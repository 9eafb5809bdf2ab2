#!/usr/bin/env bash
# clang-tidy over the sources of the project (not the tests): tidy.sh BUILD_DIR
set -euo pipefail
cd "$(dirname "$(realpath "$0")")/.."
build=${1:?usage: tidy.sh BUILD_DIR}
git ls-files 'model/*.cpp' 'control/*.cpp' 'drivers/*.cpp' 'daemon/*.cpp' 'sysid/*.cpp' 'tools/*.cpp' |
  xargs -P "$(nproc)" -n 4 clang-tidy -p "$build" --quiet
