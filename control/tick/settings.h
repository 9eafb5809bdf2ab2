#pragma once
// Defines the settings of a RigController and of its channels, in the units of the rig file. The reader of
// the rig file (rig/rig_file.h) creates them. The caller checks them with settings_problems(). The controller
// does not check them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "base/enum_table.h"
#include "control/elements/feedforward.h"
#include "control/elements/limits.h"
#include "control/elements/model_health.h"
#include "control/elements/pid.h"
#include "control/elements/plausibility.h"
#include "model/model.h"

namespace softgrip::control {

/// Settings of one finger.
struct ChannelSettings {
  std::string name;
  model::Model model;  ///< model of the free finger, without contact
  PidSettings pid;
  FeedforwardSettings feedforward;
  LimitSettings limits;
  PlausibilitySettings plausibility;
  ModelHealthSettings health;
  /// True: the channel has an input for the measured pressure, for example a monitor output of the valve.
  bool pressure_measured = false;
  /// False: the channel has no usable displacement sensor, for example because the work blocks the sensor.
  /// The readings are recorded, but they cause no faults and are not used for feedback or detection. Such a
  /// channel can only have pressure targets, and a grip can only be verified by pressure.
  bool displacement_used = true;
};

/// Largest number of channels of a rig. Status snapshots and rows of recordings have space for this number of
/// channels.
inline constexpr std::size_t max_channels = 16;

/// The phase of a rig, which determines its safe output.
enum class Phase : std::uint8_t {
  idle,       ///< no sequence runs, and no channel has the result HOLDING; also while a start waits until the
              ///< fingers are at rest
  closing,    ///< a sequence runs, no channel has the result HOLDING, and the step is not a release step
  holding,    ///< a channel has the result HOLDING, with or without a running sequence; not during a release
              ///< step
  releasing,  ///< a release step is in progress
};
/// Names of the phases: the keys of `safe_action` in the rig file.
inline constexpr auto phase_names = enum_names<Phase>({{Phase::idle, "idle"},
                                                       {Phase::closing, "closing"},
                                                       {Phase::holding, "holding"},
                                                       {Phase::releasing, "releasing"}});
inline constexpr std::size_t phase_count = phase_names.size();
[[nodiscard]] constexpr std::string_view name_of(Phase phase) noexcept {
  return phase_names[phase];
}

/// The action on the outputs when the motion must end.
enum class SafeAction : std::uint8_t {
  vent,  ///< the outputs go to the rest pressure: at the slew limit while the loop runs, at once when the
         ///< loop ends
  hold,  ///< the outputs keep the last command
};
/// Names of the actions in rig files.
inline constexpr auto safe_action_names =
    enum_names<SafeAction>({{SafeAction::vent, "vent"}, {SafeAction::hold, "hold"}});
[[nodiscard]] constexpr std::string_view name_of(SafeAction action) noexcept {
  return safe_action_names[action];
}

/// Settings of the grip detection, for all channels.
struct DetectionSettings {
  /// Smallest displacement shortfall that counts as contact with an object [mm].
  double margin_mm = 0.6;
  /// RMSE of the models of the fingers [mm]; NaN if it is unknown. margin_mm must be at least three times
  /// this RMSE.
  double model_rmse_mm = std::numeric_limits<double>::quiet_NaN();
};

/// Properties of the installation that the daemon cannot read from the bus. The rig file must give all these
/// properties.
struct SafetySettings {
  /// Action after a stop, a fault or a shutdown, for each phase in which one of them can occur.
  std::array<SafeAction, phase_count> safe_action{};
  /// Action after an emergency stop. Use `hold` only if the emergency stop circuit does not vent the fingers.
  /// If the circuit vents the fingers, a held command would fill them again when the circuit is reset.
  SafeAction on_emergency_stop = SafeAction::vent;
  /// True if the board sets its outputs to the rest pressure when communication stops. In this case, a bus
  /// fault vents the fingers in every phase. Otherwise, a held command would pressurise the fingers again
  /// after reconnection.
  bool board_vents_when_silent = true;
};

/// Number of cycles for which each fault condition may last before the fault latches. These numbers determine
/// the guaranteed reaction times of the rig.
struct FaultSettings {
  std::uint32_t bus_down_cycles = 5;         ///< number of consecutive cycles without a valid exchange
  std::uint32_t invalid_reading_cycles = 3;  ///< number of consecutive cycles in which the reading of a
                                             ///< channel is not valid
  std::uint32_t displacement_cycles = 3;     ///< number of consecutive cycles in which a reading is outside
                                             ///< the displacement range and its margin
  std::uint32_t readback_cycles = 5;         ///< number of consecutive cycles in which the output that the
                                             ///< board reports differs from the commands
  double readback_tolerance_kpa = 1;         ///< largest distance of the read-back from the range of the past
                                             ///< commands at which the two count as equal
  double readback_delay_s = 0.1;             ///< length of the past period whose commands are compared with
                                             ///< the read-back
  std::uint32_t pressure_cycles = 0;  ///< number of consecutive cycles in which the measured pressure differs
                                      ///< from the commands; 0: the pressure is not checked
  double pressure_tolerance_kpa = 5;  ///< largest distance of the measured pressure from the range of the
                                      ///< past commands at which the two count as equal
  double pressure_delay_s = 0.5;      ///< length of the past period whose commands are compared with the
                                      ///< measured pressure
  bool model_unfit_is_fault = false;  ///< true: an unfit model is a fault; false: model health is only
                                      ///< reported
  bool unsteady_is_fault = false;     ///< true: a sensor that jumps back and forth is a fault; false: such a
                                      ///< sensor is only reported
  std::uint32_t overrun_cycles = 0;   ///< number of consecutive missed cycles at which a fault occurs; 0:
                                      ///< missed cycles are only counted
};

/// All settings of a RigController.
struct RigSettings {
  double rate_hz = 200;                   ///< rate at which tick() is called
  std::vector<ChannelSettings> channels;  ///< settings of 1 to max_channels channels; their names must differ
  SafetySettings safety;
  double rest_band_mm = 0.2;   ///< a finger is at rest if its readings stay within this band for rest_time_s
  double rest_time_s = 0.3;    ///< time for which the readings must stay within rest_band_mm; a sequence
                               ///< starts only from rest
  double rest_timeout_s = 10;  ///< longest wait for the fingers to come to rest; after this time, the start
                               ///< ends with ERROR
  DetectionSettings detection;
  FaultSettings faults;
};

/// Returns the problems of the settings, one sentence each. If the list is empty, RigController accepts the
/// settings. The reader of the rig file reports most problems with their location in the file. This function
/// also checks relations between settings, and settings that do not come from a rig file.
[[nodiscard]] std::vector<std::string> settings_problems(const RigSettings& settings);

}  // namespace softgrip::control
