#pragma once
// Defines the faults of the emulated rig, and reads faults files:
//
//   faults:
//     - name: slow_wire
//       kind: dripped_reply
//       at_s: 5
//       for_s: 2
//       replies: 1
//       interval_s: 0.05
//
// The fault begins at_s seconds after the first command to an output. Without at_s, the fault begins only
// when a control command triggers it. docs/reference/emulator.md describes the file.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "document/node.h"
#include "simulation/plant/plant.h"

namespace softgrip::document {
struct KeyFacts;
}

namespace softgrip::simulation {

enum class FaultKind : std::uint8_t {
  // the following kinds are faults of the transmission
  lost_request,       ///< the request is lost: the board neither executes nor answers the request
  no_reply,           ///< the board executes the request, but sends no reply
  late_reply,         ///< the reply is delayed by delay_s, so it may arrive after the replies to later
                      ///< requests
  dripped_reply,      ///< the reply is sent as single bytes, one byte every interval_s
  cut_reply,          ///< only the first half of the reply is sent
  repeated_reply,     ///< the reply is sent twice
  wrong_unit,         ///< the unit id in the reply is 1 higher than the correct unit id
  wrong_transaction,  ///< the transaction id in the reply is 1 higher than the correct transaction id
  wrong_length,       ///< the length in the header of the reply is 1 higher than the correct length
  exception_reply,    ///< the reply is the Modbus exception `code`, and the request is not executed
  settling,           ///< requests that arrive within settle_s after the connection was opened are lost
  few_registers,      ///< a request for more than `most` registers gets exception 3 as reply
  stray_bytes,        ///< each reply has `before` extra bytes before its start, and `behind` extra bytes
                      ///< after its end
  disconnect,         ///< the emulator closes open connections, and immediately closes each new connection
  // the following kind is a fault of the board
  ignored_write,  ///< the board confirms writes but does not execute them
  // the following kinds are faults of a channel
  sensor_stuck,         ///< the sensor repeats its last value
  sensor_jumping,       ///< by_mm is added to the reading in the first, third, fifth ... interval of
                        ///< interval_s
  sensor_out_of_range,  ///< the sensor gives no valid reading
  line_blocked,         ///< the pressure of the finger stays constant, because commands do not reach the
                        ///< finger
  line_leaking,         ///< the finger receives (1 - share) of the commanded pressure
  object_removed,       ///< the object is removed at the start of the fault, and put back at its end
};

[[nodiscard]] std::string_view name_of(FaultKind kind) noexcept;

/// Returns true for a fault of the transmission, which loses requests or changes replies.
[[nodiscard]] constexpr bool on_the_wire(FaultKind kind) noexcept {
  return kind <= FaultKind::disconnect;
}
/// Returns true for a fault that affects a channel.
[[nodiscard]] constexpr bool of_a_channel(FaultKind kind) noexcept {
  return kind >= FaultKind::sensor_stuck;
}

/// One entry of a faults file. The members from `delay_s` on belong to single kinds of faults.
struct FaultSpec {
  std::string name;
  FaultKind kind = FaultKind::no_reply;
  std::optional<double> at_s;
  std::optional<double> for_s;
  std::optional<std::uint32_t> replies;
  std::optional<std::size_t> channel;  ///< channel that a channel fault affects; nullopt: all channels

  double delay_s = 0;
  double interval_s = 0;
  std::uint8_t code = 0;
  double settle_s = 0;
  std::uint16_t most = 0;
  std::uint16_t before = 0;
  std::uint16_t behind = 0;
  LineFault line;      ///< used by the kinds line_blocked and line_leaking
  SensorFault sensor;  ///< used by the kinds sensor_stuck, sensor_jumping and sensor_out_of_range
};

/// Returns a fault of this kind with default values and without a name.
[[nodiscard]] FaultSpec fault_of(FaultKind kind);

/// Returns all keys of a fault in a faults file.
[[nodiscard]] std::vector<document::KeyFacts> faults_file_keys();

/// Reads a faults file for a rig with the channels `channels`. Adds the problems of the file to `problems`.
/// The result may only be used if no problem was added.
[[nodiscard]] std::vector<FaultSpec> read_faults(const document::Document& document,
                                                 const std::vector<std::string>& channels,
                                                 document::Problems& problems);

}  // namespace softgrip::simulation
