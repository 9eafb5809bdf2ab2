#!/usr/bin/env bash
# Installs the library into a folder and moves the folder. Builds examples/cpp with find_package, and one example with
# pkg-config. Then runs the examples. Usage: examples.sh BUILD
set -euo pipefail
build=$(realpath "$1")
. "$(dirname "$0")/example_runs.sh"
work=$(mktemp -d) && trap 'end_daemon; rm -rf "$work"' EXIT
cd "$work"

cmake --install "$build" --component library --prefix "$work/first" >install.log
mv first installed
for word in Eigen nlohmann CLI/ yaml ceres tl/expected; do
  ! grep -rn "include.*$word" installed/include || fail "a public header includes $word"
done
[ "$(ls installed/include)" = softgrip ] || fail "headers outside include/softgrip"

cmake -S "$source/examples/cpp" -B examples -DCMAKE_PREFIX_PATH="$work/installed" -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_FLAGS="-Wall -Wextra -Wpedantic -Werror" >configure.log || { cat configure.log; fail "find_package"; }
cmake --build examples -j 2 >build.log 2>&1 || { cat build.log; fail "build"; }
run_examples examples "$build/tools/softgrip" "$build/daemon/softgripd"

# A late response must not become the reading of a later command. Each failure has a status and a reason.
libraries=$work/$(dirname "$(find installed -name libsoftgrip.so)")
c++ -std=c++20 -I installed/include -I "$source/examples/cpp" "$source/tests/library/board_driver_faults.cpp" -L "$libraries" \
  -Wl,-rpath,"$libraries" -lsoftgrip -pthread -o board_driver_faults
./board_driver_faults >faults.txt
diff - faults.txt <<'END' || fail "board_driver.cpp handles a failure of its board wrongly"
late responses
connect: ok
5 kPa: ok, 1.0 mm
10 kPa: timed_out, -1.0 mm (Connection timed out)
20 kPa: disconnected, -1.0 mm (Transport endpoint is not connected)
connect: ok
30 kPa: ok, 6.0 mm
signals during an exchange
40 kPa: ok, 8.0 mm
10 kPa: timed_out, -1.0 mm (Connection timed out)
one byte per 0.3 s, a closed connection, an error, and no board
connect: ok
1 kPa: timed_out, -1.0 mm (Connection timed out)
connect: ok
1 kPa: disconnected, -1.0 mm (Connection reset by peer)
connect: ok
1 kPa: bad_reply, -1.0 mm (Bad message)
connect: disconnected (Connection refused)
a board that permits one client
connect: ok
connect: ok
END

if command -v pkg-config >/dev/null; then
  folder=$(find installed -name softgrip.pc -printf '%h\n')
  export PKG_CONFIG_PATH=$work/$folder
  c++ -std=c++20 "$source/examples/cpp/simulate_finger.cpp" $(pkg-config --cflags --libs softgrip) \
    -Wl,-rpath,"$work/$(dirname "$folder")" -o by_pkg_config
  says "19.99," ./by_pkg_config "$model"
fi
for example in "$source"/examples/cpp/*.cpp; do
  [ "$(wc -l <"$example")" -le 80 ] || fail "$example has more than 80 lines"
done
echo "examples built and ran"
