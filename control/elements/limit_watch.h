#pragma once
// A limit that keeps a command from what is wanted for longer than a moment is worth telling: what was asked
// for is not what goes out.

#include <cstdint>
#include <optional>
#include <string_view>

namespace softgrip::control {

/// What keeps a command from what is wanted. The rest pressure is not among them: a finger that is let go
/// stands at it.
enum class BindingLimit : std::uint8_t {
  none,
  rig_pressure,   ///< limits: pressure_max_kpa of the rig file
  step_pressure,  ///< pressure_max_kpa of the sequence's step
  step_squeeze,   ///< squeeze_max_kpa of the sequence's step
  rig_slew_up,    ///< limits: slew_up_kpa_per_s of the rig file
  rig_slew_down,  ///< limits: slew_down_kpa_per_s of the rig file
};
/// "none", "rig_pressure", "step_pressure", "step_squeeze", "rig_slew_up", "rig_slew_down"
[[nodiscard]] std::string_view name_of(BindingLimit limit) noexcept;
/// "pressure_max_kpa of the rig keeps the pressure down"; empty of none.
[[nodiscard]] std::string_view words_of(BindingLimit limit) noexcept;

/// Tells of a limit when limits have bound a command for `moment_s`, of another one that has taken its place
/// for as long, and when they have let go of it. Shorter gaps than `gap_s` do not count: noise takes a
/// command across its ceiling again and again.
class LimitWatch {
 public:
  static constexpr double moment_s = 0.5;
  static constexpr double gap_s = 0.1;

  /// One tick. A value where what stands() has just changed.
  std::optional<BindingLimit> observe(double time_s, BindingLimit now) noexcept;
  /// The limit that binds and was told.
  [[nodiscard]] BindingLimit stands() const noexcept { return told_; }

 private:
  BindingLimit told_ = BindingLimit::none;
  BindingLimit now_ = BindingLimit::none;
  double since_s_ = 0;   ///< one or another binds
  double change_s_ = 0;  ///< the present one does
  double last_s_ = 0;
};

}  // namespace softgrip::control
