// Fuzz target: passes arbitrary bytes to the reader of board maps. The reader must return a map with usable
// values, or refuse the bytes with a message that states line and column.
//
//   Command: scripts/fuzz.sh board_map_fuzz 30

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "rig/board_map_file.h"
#include "tests/support/require.h"

namespace {

using namespace softgrip;

using test::require;

void check(const drivers::TerminalBlock& block) {
  if (block.registers.count == 0) return;  // this module has no inputs or no outputs
  require(std::isfinite(block.raw_min) && std::isfinite(block.raw_max) && block.raw_min < block.raw_max);
  for (const double raw : {block.raw_min, block.raw_max}) {
    const double electrical = block.scaling.y_at(raw);
    require(std::isfinite(electrical) && std::isfinite(block.scaling.x_at(electrical)));
  }
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  document::Problems problems;
  const document::Document document =
      document::parse("fuzz.yaml", std::string(reinterpret_cast<const char*>(data), size), problems);
  const auto map = rig::read_board_map(document, problems);
  (void)problems.format();
  require(map.has_value() || !problems.empty());
  if (!map || !problems.empty()) return 0;
  require(map->inputs.registers.count + map->outputs.registers.count > 0);
  check(map->inputs);
  check(map->outputs);
  require(!map->name.empty());
  return 0;
}
