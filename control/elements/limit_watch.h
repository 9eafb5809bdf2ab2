#pragma once
// A limit that keeps a command down for longer than a moment is worth telling: what was asked for is not what
// goes out.

#include <cstdint>
#include <optional>
#include <string_view>

namespace softgrip::control {

/// What keeps a command below what is wanted.
enum class UpperLimit : std::uint8_t {
  none,
  rig_pressure,   ///< limits: pressure_max_kpa of the rig file
  step_pressure,  ///< pressure_max_kpa of the sequence's step
  step_squeeze,   ///< squeeze_max_kpa of the sequence's step
};
/// "none", "rig_pressure", "step_pressure", "step_squeeze"
[[nodiscard]] std::string_view name_of(UpperLimit limit) noexcept;

/// Tells of a limit when it has kept a command down for `moment_s`, and when it has let go of it. Shorter
/// gaps than `gap_s` do not count: noise takes a command across its ceiling again and again.
class LimitWatch {
 public:
  static constexpr double moment_s = 0.5;
  static constexpr double gap_s = 0.1;

  /// One tick. A value where what stands() has just changed.
  std::optional<UpperLimit> observe(double time_s, UpperLimit now) noexcept;
  /// The limit that binds and was told.
  [[nodiscard]] UpperLimit stands() const noexcept { return told_; }

 private:
  UpperLimit told_ = UpperLimit::none;
  UpperLimit now_ = UpperLimit::none;
  double since_s_ = 0;
  double last_s_ = 0;
};

}  // namespace softgrip::control
