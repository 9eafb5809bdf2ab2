#!/usr/bin/env bash
# Installs the packages that scripts/package.sh has built. Builds the C++ examples with the commands of
# docs/how-to/library-cpp.md. Then runs the C++ and Python examples. The machine must have no other files of softgrip,
# so use a chroot: scripts/chroot_test.sh bookworm bash tests/library/installed_examples.sh
set -euo pipefail
. "$(dirname "$0")/example_runs.sh"
work=$(mktemp -d) && trap 'end_daemon; rm -rf "$work"' EXIT

packages=(cmake make g++ python3-numpy)
for name in softgrip libsoftgrip0 libsoftgrip-dev python3-softgrip; do
  file=$(ls -t "$source/build/${name}"_*.deb 2>/dev/null | head -n 1)
  [ -n "$file" ] || fail "no package $name in build; scripts/package.sh builds it"
  packages+=("$file")
done
export DEBIAN_FRONTEND=noninteractive
apt-get -q update >"$work/apt.log"
apt-get -q install -y --no-install-recommends "${packages[@]}" >>"$work/apt.log" 2>&1 || { cat "$work/apt.log" >&2; fail "apt-get"; }

cd "$work"
# Extracts from docs/how-to/library-cpp.md the commands that copy and build the examples.
sed -n '/^ *cp -r \/usr\/share\/doc\/libsoftgrip-dev/,/```/p' "$source/docs/how-to/library-cpp.md" | grep -v '```' >lines.sh
[ "$(wc -l <lines.sh)" -eq 3 ] || fail "docs/how-to/library-cpp.md has no 3 lines that build the examples"
bash -eu lines.sh >build.log 2>&1 || { cat build.log >&2; fail "build"; }
run_examples build-examples softgrip "$(command -v softgripd)"

mkdir -p installed/tools installed/daemon
ln -s "$(command -v softgrip)" installed/tools/softgrip
ln -s "$(command -v softgripd)" installed/daemon/softgripd
(cd "$source/tests/python" && SOFTGRIP_BUILD=$work/installed /usr/bin/python3 -m unittest test_examples)
echo "the examples of C++ and Python ran with the installed packages"
