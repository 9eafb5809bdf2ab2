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

/// Largest number of channels of a rig. It gives snapshots and rows of recordings a fixed size.
inline constexpr std::size_t max_channels = 16;

/// The phase of a rig, which determines its safe output.
enum class Phase : std::uint8_t {
  idle,       ///< no sequence runs, or a sequence is starting or resynchronising
  closing,    ///< approach, grip, settle and verify; also tracking and pressure steps of studies
  holding,    ///< a hold step is in progress
  releasing,  ///< a release step is in progress
};
inline constexpr std::size_t phase_count = 4;
/// Returns "idle", "closing", "holding" or "releasing". These are the keys of `safe_action` in the rig file.
[[nodiscard]] std::string_view name_of(Phase phase) noexcept;

/// The action of the outputs when motion must end.
enum class SafeAction : std::uint8_t {
  vent,  ///< go to the rest pressure: at the slew limit while the loop runs, at once when the loop ends
  hold,  ///< the outputs keep the last command
};
/// Returns the name of an action: "vent" or "hold".
[[nodiscard]] std::string_view name_of(SafeAction action) noexcept;

/// Settings of the grip detection, for all channels.
struct DetectionSettings {
  /// A finger is in contact with an object if its displacement shortfall is at least this [mm].
  double margin_mm = 0.6;
  /// RMSE of the models; NaN if it is unknown. The margin must be at least three times the RMSE.
  double model_rmse_mm = std::numeric_limits<double>::quiet_NaN();
};

/// Properties of the installation that the daemon cannot read from the bus. The rig file must give all of
/// them.
struct SafetySettings {
  /// Action of a stop, a fault or a shutdown, for each phase in which it can occur.
  std::array<SafeAction, phase_count> safe_action{};
  /// Action of an emergency stop. Use `hold` only if the emergency stop circuit does not vent the fingers. If
  /// the circuit vents them, a held command would fill the fingers again when the circuit is reset.
  SafeAction on_emergency_stop = SafeAction::vent;
  /// True if the board sets its outputs to the rest pressure when communication stops. In this case, bus
  /// faults vent in every phase, because a held command would pressurise the fingers again after
  /// reconnection.
  bool board_vents_when_silent = true;
};

/// Number of cycles for which a condition may last before it is a fault. These numbers determine the
/// guaranteed reaction times of the rig. docs/reference/rig-file.md states the meaning of each member in the
/// section `faults`.
struct FaultSettings {
  std::uint32_t bus_down_cycles = 5;
  std::uint32_t invalid_reading_cycles = 3;
  std::uint32_t displacement_cycles = 3;
  std::uint32_t readback_cycles = 5;
  double readback_tolerance_kpa = 1;
  double readback_delay_s = 0.1;
  std::uint32_t pressure_cycles = 0;
  double pressure_tolerance_kpa = 5;
  double pressure_delay_s = 0.5;
  bool model_unfit_is_fault = false;
  bool unsteady_is_fault = false;
  std::uint32_t overrun_cycles = 0;
};

/// All settings of a RigController.
struct RigSettings {
  double rate_hz = 200;                   ///< rate at which tick() is called
  std::vector<ChannelSettings> channels;  ///< settings of 1 to max_channels channels; their names must differ
  SafetySettings safety;
  double rest_band_mm = 0.2;   ///< a finger is at rest if its readings stay within this band for rest_time_s
  double rest_time_s = 0.3;    ///< time for which the readings must stay within rest_band_mm; a sequence
                               ///< starts only from rest
  double rest_timeout_s = 10;  ///< if the fingers do not come to rest within this time, the start ends with
                               ///< ERROR
  DetectionSettings detection;
  FaultSettings faults;
};

/// Returns the problems of the settings, one sentence each. If the list is empty, RigController accepts the
/// settings. The reader of the rig file reports most problems with their location. This function also checks
/// relations between keys, and settings that code has made.
[[nodiscard]] std::vector<std::string> settings_problems(const RigSettings& settings);

}  // namespace softgrip::control
