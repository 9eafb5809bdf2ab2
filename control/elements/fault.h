#pragma once
// Defines the fault codes and their descriptions. A fault stays latched until an operator resets it. The code
// of a fault never changes, because the code appears in events, recordings, metrics and the manual.
// Returns the message for a refused request.

#include <cstdint>
#include <span>
#include <string_view>

namespace softgrip::control {

/// The fault codes. A code is shown after an F: 101 is "F101". The hundreds digit is the group of the fault:
/// 1 bus, 2 readings, 3 board and outputs, 4 model, 5 safety, 9 internal.
enum class FaultCode : std::uint16_t {
  none = 0,
  bus_down = 101,              ///< no connection to the board, or no valid exchange for bus_down_cycles
                               ///< consecutive cycles
  bus_timed_out = 102,         ///< the board does not respond in time
  bus_bad_reply = 103,         ///< the response does not match the request
  bus_exception = 104,         ///< the board rejects the Modbus function or the register address
  reading_stale = 201,         ///< no new reading of a channel has arrived within max_age_s
  reading_out_of_range = 202,  ///< the reading is outside the sensor's electrical range
  sensor_error = 203,          ///< the sensor or the board reports an error code in place of a reading
  reading_jumped = 204,        ///< the reading changed faster than a finger can move
  reading_frozen = 205,        ///< the reading stayed constant while the command changed
  displacement_beyond_limits = 206,
  pressure_not_followed = 207,  ///< the measured pressure has differed from all recent commands for
                                ///< pressure_cycles cycles
  pressure_invalid = 208,       ///< the pressure monitor of a channel gives no valid reading
  readback_mismatch = 301,      ///< the output that the board reports differs from the command that was
                                ///< written
  write_refused = 302,          ///< the board rejected the command that was written
  board_watchdog_tripped = 303,
  outputs_overwritten = 304,  ///< another Modbus client writes to the board
  model_unfit = 401,
  emergency_stop = 501,
  inputs_lost = 502,  ///< the digital inputs cannot be read
  cycles_lost = 901,  ///< the control loop missed too many consecutive cycles (overrun_cycles or
                      ///< max_missed_commands)
  not_finite = 902,   ///< a pressure command was NaN or infinite
};

/// Description of a fault in the manual and in events.
struct FaultInfo {
  FaultCode code;
  std::string_view id;       ///< id of the fault, such as "F101"
  std::string_view name;     ///< name of the fault, such as "bus_down"
  std::string_view meaning;  ///< meaning of the fault in one sentence
  std::string_view cause;    ///< usual cause of the fault
  std::string_view remedy;   ///< action that the user must take before the reset (`acknowledge`)
  std::string_view bound;    ///< number of cycles until the fault latches, in terms of the keys of the rig
                             ///< file, such as "invalid_reading_cycles + 1"
};

/// Returns all faults in the order of their codes, without `none`.
[[nodiscard]] std::span<const FaultInfo> all_faults() noexcept;
/// Returns the description of a fault. The description of `none` and of an unknown number has the id "F000"
/// and the name "none".
[[nodiscard]] const FaultInfo& info_of(FaultCode code) noexcept;

/// Returns true if the pressures at the board's outputs can differ from the commands of the control loop
/// after this fault.
[[nodiscard]] constexpr bool inhibits(FaultCode code) noexcept {
  return code == FaultCode::cycles_lost || code == FaultCode::board_watchdog_tripped ||
         code == FaultCode::write_refused || code == FaultCode::outputs_overwritten;
}

/// The reason why a request was refused.
enum class RefusalCode : std::uint16_t {
  none = 0,
  faulted = 1,   ///< the request was refused because a fault is latched
  not_idle = 2,  ///< a sequence runs, is starting or is being stopped
  interlock_open = 3,
  emergency_stop = 4,
  sequence_unfit = 5,    ///< no sequence was given, or the sequence was prepared for another rig
  no_valid_reading = 6,  ///< the rig is starting, or a channel that the sequence uses has no valid reading
  nothing_to_stop = 7,
  nothing_to_acknowledge = 8,
  cause_persists = 9,            ///< a reset was requested while the cause of a latched fault was still
                                 ///< present
  overtaken = 10,                ///< a stop or vent request arrived before the loop accepted the start, so
                                 ///< the start was dropped
  nothing_to_release = 11,       ///< no sequence runs, and every channel is at its rest pressure
  named_start_not_running = 12,  ///< the request stops one particular start, but no sequence of this start
                                 ///< runs
};
/// Returns the id of a refusal, for example "R01". The function name_of() returns the name of the refusal in
/// snake_case.
[[nodiscard]] std::string_view id_of(RefusalCode code) noexcept;
[[nodiscard]] std::string_view name_of(RefusalCode code) noexcept;

struct RefusalText {
  std::string_view meaning;  ///< reason for the refusal in one sentence
  std::string_view next;     ///< action that the user should take next, with the command for this action
};

/// Returns the texts for the code of a refusal. For `none` and for unknown codes, the text says that the
/// request was not refused.
[[nodiscard]] const RefusalText& text_of(RefusalCode code) noexcept;

}  // namespace softgrip::control
