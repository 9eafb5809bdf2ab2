// Fuzz target: passes arbitrary bytes to softgrip-plc as a master would send them, in pieces of any size. No
// daemon runs.
//
//   Command: scripts/fuzz.sh plc_request_fuzz 30

#include <algorithm>
#include <cstdint>
#include <span>

#include "tests/support/require.h"
#include "tools/plc/gateway.h"

namespace {

using namespace softgrip;

using test::require;

plc::Settings shipped() {
  document::Problems problems;
  auto settings = plc::load_settings(SOFTGRIP_SOURCE_DIR "/config/plc.yaml", problems);
  require(settings.has_value());
  settings->socket = "/nonexistent/softgripd.sock";
  return *settings;
}

/// Checks that the reply is exactly one complete frame. Also checks that the reply matches the request.
void check(const modbus::Request& request, const modbus::Reply& reply) {
  require(reply.pieces.size() == 1 && !reply.disconnect);
  const std::span<const std::uint8_t> frame = reply.pieces.front().bytes;
  constexpr std::size_t header = 7;
  require(frame.size() >= header + 2 && frame.size() <= header + modbus::max_pdu);
  require(modbus::word_at(frame, 0) == request.transaction && frame[6] == request.unit);
  require(modbus::word_at(frame, 4) == frame.size() - 6);
  require((frame[header] & 0x7fU) == (request.pdu[0] & 0x7fU));
}

/// Returns the value of a register that the gateway writes. Reads this register with a separate request.
std::uint16_t read(plc::Gateway& gateway, plc::ClientConnections::Id id, std::uint16_t address,
                   Nanoseconds now) {
  modbus::Request request{0, 1, {3}};
  modbus::append_word(request.pdu, address);
  modbus::append_word(request.pdu, 1);
  const modbus::Reply reply = gateway.serve(id, request, now);
  return modbus::word_at(reply.pieces.front().bytes, 9);
}

}  // namespace

// NOLINTNEXTLINE(readability-identifier-naming): libFuzzer's name
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using plc::Name;
  static const plc::Settings settings = shipped();
  plc::Gateway gateway(settings);
  const auto master = gateway.connections().admit("127.0.0.1", 0);
  const auto other = gateway.connections().admit("127.0.0.1", 0);
  require(master && other);
  modbus::RequestStream stream;
  std::span<const std::uint8_t> bytes(data, size);
  Nanoseconds now = 0;
  while (!bytes.empty() && !stream.broken()) {
    const std::size_t piece = std::min<std::size_t>(bytes.size(), 1 + bytes.front() % 32);
    stream.append(bytes.first(piece));
    bytes = bytes.subspan(piece);
    while (const auto request = stream.next()) {
      now += 10'000'000;
      check(*request, gateway.serve(*master, *request, now));
      require(read(gateway, *other, settings.registers.at(Name::map_version), now) == plc::version_of_map);
      // Without a daemon, the gateway must not report a command as executing or accepted.
      for (const auto reader : {*master, *other}) {
        const auto outcome =
            static_cast<plc::Outcome>(read(gateway, reader, settings.registers.at(Name::outcome), now));
        require(outcome == plc::Outcome::none || outcome == plc::Outcome::refused);
      }
      require(gateway.take_lines_to_daemon().empty());
    }
  }
  return 0;
}
