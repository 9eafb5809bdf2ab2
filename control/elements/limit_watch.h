#pragma once
// Reports a limit that has restricted a command for at least LimitWatch::moment_s.

#include <cstdint>
#include <optional>
#include <string_view>

namespace softgrip::control {

/// The limit that restricts a command. The rest pressure is not one of these limits, because every released
/// finger has the rest pressure as command.
enum class BindingLimit : std::uint8_t {
  none,
  rig_pressure,   ///< pressure_max_kpa under `limits` in the rig file
  step_pressure,  ///< pressure_max_kpa of the sequence's step
  step_squeeze,   ///< squeeze_max_kpa of the sequence's step
  rig_slew_up,    ///< slew_up_kpa_per_s under `limits` in the rig file
  rig_slew_down,  ///< slew_down_kpa_per_s under `limits` in the rig file
};
/// Returns the name of a limit: "none", "rig_pressure", "step_pressure", "step_squeeze", "rig_slew_up" or
/// "rig_slew_down".
[[nodiscard]] std::string_view name_of(BindingLimit limit) noexcept;
/// Returns the message for a limit, for example "pressure_max_kpa of the rig limits the pressure"; empty for
/// `none`.
[[nodiscard]] std::string_view words_of(BindingLimit limit) noexcept;

/// Reports which limit restricts a command. A limit is reported after limits have restricted the command for
/// `moment_s`. If a different limit restricts the command for `moment_s` after a report, the new limit is
/// reported. The value `none` is reported when no limit restricts the command any more. Interruptions shorter
/// than `gap_s` are ignored, because noise can move a command across a limit repeatedly.
class LimitWatch {
 public:
  static constexpr double moment_s = 0.5;
  static constexpr double gap_s = 0.1;

  /// Processes one tick. Returns reported() if the value of reported() has changed in this tick, otherwise
  /// nothing.
  std::optional<BindingLimit> observe(double time_s, BindingLimit now) noexcept;
  /// Returns the last reported limit; `none` after the command has become free of limits.
  [[nodiscard]] BindingLimit reported() const noexcept { return reported_; }

 private:
  BindingLimit reported_ = BindingLimit::none;
  BindingLimit now_ = BindingLimit::none;
  double since_s_ = 0;   ///< time since which limits have restricted the command, with interruptions below
                         ///< gap_s
  double change_s_ = 0;  ///< time at which the present limit began to restrict the command
  double last_s_ = 0;
};

}  // namespace softgrip::control
