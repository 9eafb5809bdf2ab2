#pragma once
// What can go wrong with the emulated rig, as a faults file says it, and the reader of that file.
//
//   faults:
//     - name: slow_wire
//       kind: dripped_reply
//       at_s: 5           # since the first command to an output; without it: only when it is triggered
//       for_s: 2          # without it: until it is cleared
//       replies: 1        # faults of the wire only: ends after so many requests that it touched
//       interval_s: 0.05  # the kind's own keys, all required
//
// docs/reference/emulator.md is the manual of the file.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/node.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

enum class FaultKind : std::uint8_t {
  // of the wire
  lost_request,       ///< the request never arrives: nothing is carried out, nothing answered
  no_reply,           ///< carried out, not answered
  late_reply,         ///< answered after delay_s, perhaps after later replies
  dripped_reply,      ///< one byte every interval_s
  cut_reply,          ///< the first half of the reply, then nothing
  repeated_reply,     ///< the reply twice
  wrong_unit,         ///< unit id one too high
  wrong_transaction,  ///< transaction id one too high
  wrong_length,       ///< the header announces one byte more than there is
  exception_reply,    ///< Modbus exception `code`; nothing is carried out
  settling,           ///< requests within settle_s after the connection was opened never arrive
  few_registers,      ///< a request for more than `most` registers: exception 3
  stray_bytes,        ///< `before` bytes before each reply, `behind` bytes behind it
  disconnect,         ///< connections are closed and new ones closed at once
  // of the board
  ignored_write,  ///< writes are answered and have no effect
  // of a channel
  sensor_stuck,         ///< repeats its last value
  sensor_jumping,       ///< off by by_mm in every other interval_s
  sensor_out_of_range,  ///< sees nothing
  line_blocked,         ///< the finger's pressure stays what it is
  line_leaking,         ///< the finger gets (1 - share) of the pressure
  object_removed,       ///< the object is pulled out, and put back when this ends
};

[[nodiscard]] std::string_view name_of(FaultKind kind) noexcept;

/// Whether it spoils replies, and not a channel or the board.
[[nodiscard]] constexpr bool on_the_wire(FaultKind kind) noexcept {
  return kind <= FaultKind::disconnect;
}
/// Whether it belongs to one channel.
[[nodiscard]] constexpr bool of_a_channel(FaultKind kind) noexcept {
  return kind >= FaultKind::sensor_stuck;
}

/// One entry of a faults file. Of the last group only what its kind needs means something.
struct FaultSpec {
  std::string name;
  FaultKind kind = FaultKind::no_reply;
  std::optional<double> at_s;
  std::optional<double> for_s;
  std::optional<std::uint32_t> replies;
  std::optional<std::size_t> channel;  ///< of a channel fault; absent: all channels

  double delay_s = 0;
  double interval_s = 0;
  std::uint8_t code = 0;
  double settle_s = 0;
  std::uint16_t most = 0;
  std::uint16_t before = 0;
  std::uint16_t behind = 0;
  LineFault line;      ///< line_blocked, line_leaking
  SensorFault sensor;  ///< sensor_stuck, sensor_jumping, sensor_out_of_range
};

/// A fault of this kind, without a name and with nothing of its own.
[[nodiscard]] FaultSpec fault_of(FaultKind kind);

/// Reads a faults file for a rig with these channels. Problems are added to `problems`; the result means
/// something only if none were.
[[nodiscard]] std::vector<FaultSpec> read_faults(const document::Document& document,
                                                 const std::vector<std::string>& channels,
                                                 document::Problems& problems);

}  // namespace softgrip::simulation
