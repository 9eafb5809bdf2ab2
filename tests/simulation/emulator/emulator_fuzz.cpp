// Fuzz target: sends arbitrary bytes to the emulator. The bytes arrive in pieces of 1 to 32 bytes.
//
//   Command: scripts/fuzz.sh emulator_fuzz 30

#include <algorithm>
#include <cstdint>
#include <span>

#include "drivers/modbus_server/requests.h"
#include "rig/board_map_file.h"
#include "simulation/emulator/emulated_board.h"
#include "tests/support/require.h"

namespace {

using namespace softgrip;

using test::require;

drivers::BoardMap sim_board() {
  document::Problems problems;
  auto map = rig::load_board_map(SOFTGRIP_SOURCE_DIR "/config/boards/softgrip-sim.yaml", problems);
  require(map.has_value());
  return *map;
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const drivers::BoardMap map = sim_board();
  simulation::EmulatedBoard board(map);
  modbus::RequestStream stream;
  std::span<const std::uint8_t> bytes(data, size);
  Nanoseconds now = 0;
  while (!bytes.empty()) {
    const std::size_t piece = std::min<std::size_t>(bytes.size(), 1 + bytes.front() % 32);
    stream.append(bytes.first(piece));
    bytes = bytes.subspan(piece);
    while (const auto request = stream.next()) {
      now += 10'000'000;
      const auto answer = board.answer(now, request->pdu);
      require(answer.pdu.size() >= 2 && answer.pdu.size() <= simulation::max_pdu);
      require((answer.pdu[0] & 0x7fU) == (request->pdu[0] & 0x7fU));
    }
  }
  return 0;
}
