#pragma once
// Defines the settings of a RigController as plain values. The reader of the rig file (rig/rig_file.h)
// creates them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "control/tick/channel_settings.h"

namespace softgrip::control {

/// Largest number of channels of a rig, so that snapshots and rows have a fixed size.
inline constexpr std::size_t max_channels = 16;

/// The phase of a rig, which determines its safe output.
enum class Phase : std::uint8_t {
  idle,       ///< no sequence runs (also: starting, re-synchronising)
  closing,    ///< approach, grip, settle, verify; tracking and pressure steps of studies
  holding,    ///< a hold step
  releasing,  ///< a release step
};
inline constexpr std::size_t phase_count = 4;
/// Returns "idle", "closing", "holding" or "releasing": the keys of `safe_action` in the rig file.
[[nodiscard]] std::string_view name_of(Phase phase) noexcept;

/// The action of the outputs if motion must end.
enum class SafeAction : std::uint8_t {
  vent,  ///< go to rest: at the slew limit while the loop runs, at once when it ends
  hold,  ///< stay at the last command
};
/// Returns "vent" or "hold".
[[nodiscard]] std::string_view name_of(SafeAction action) noexcept;

/// Grip detection, for all channels.
struct DetectionSettings {
  /// A finger whose displacement shortfall is at least this is in contact with an object.
  double margin_mm = 0.6;
  /// RMSE of the models, if known (NaN: unknown). The margin must be at least three times as large.
  double model_rmse_mm = std::numeric_limits<double>::quiet_NaN();
};

/// Properties of the installation behind the bus. All are explicit in the rig file.
struct SafetySettings {
  /// Action of a stop, a fault or a shutdown, by the phase in which it occurs.
  std::array<SafeAction, phase_count> safe_action{};
  /// Action of an emergency stop. Use `hold` only if the circuit of the emergency stop does not vent the
  /// fingers: a held command would fill vented fingers again when the circuit is reset.
  SafeAction on_emergency_stop = SafeAction::vent;
  /// True if the board sets its outputs to the rest pressure when communication stops. Then bus faults vent
  /// in every phase, because a held command would pressurise the fingers again on reconnection.
  bool board_vents_when_silent = true;
};

/// Number of cycles for which a condition may last before it is a fault. These numbers determine the
/// guaranteed reaction times of the rig.
struct FaultSettings {
  std::uint32_t bus_down_cycles = 5;         ///< consecutive cycles without a valid exchange
  std::uint32_t invalid_reading_cycles = 3;  ///< consecutive cycles in which a channel's reading is not valid
  std::uint32_t displacement_cycles = 3;     ///< consecutive cycles outside the displacement range of the
                                             ///< limits
  std::uint32_t readback_cycles = 5;         ///< consecutive cycles in which the read-back differs from the
                                             ///< commands
  double readback_tolerance_kpa = 1;         ///< the read-back differs if it is outside the range of the past
                                             ///< commands by more than this
  double readback_delay_s = 0.1;             ///< duration of the window of past commands
  std::uint32_t pressure_cycles = 0;  ///< consecutive cycles with a wrong measured pressure; 0: not checked
  double pressure_tolerance_kpa = 5;  ///< the pressure differs if it is outside the range of the past
                                      ///< commands by more than this
  double pressure_delay_s = 0.5;      ///< duration of the window of past commands
  bool model_unfit_is_fault = false;  ///< false: model health is only reported
  bool unsteady_is_fault = false;     ///< true: a sensor that jumps back and forth is a fault; false: it is
                                      ///< only reported
  std::uint32_t overrun_cycles = 0;   ///< number of cycles missed at once that is a fault; 0: missed cycles
                                      ///< are only counted
};

/// All settings of a RigController.
struct RigSettings {
  double rate_hz = 200;                   ///< rate of tick()
  std::vector<ChannelSettings> channels;  ///< 1 to max_channels, names unique
  SafetySettings safety;
  double rest_band_mm = 0.2;   ///< a finger is at rest while its readings stay within this band ...
  double rest_time_s = 0.3;    ///< ... for this time; a sequence starts only from rest
  double rest_timeout_s = 10;  ///< a start without rest within this time ends with ERROR
  DetectionSettings detection;
  FaultSettings faults;
};

/// Returns the problems of the settings, one sentence each. If the list is empty, RigController accepts them.
/// The rig file's reader reports most problems with their location. This function covers relations between
/// keys and settings made in code.
[[nodiscard]] std::vector<std::string> settings_problems(const RigSettings& settings);

}  // namespace softgrip::control
