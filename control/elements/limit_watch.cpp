#include "control/elements/limit_watch.h"

#include <array>
#include <cstddef>

namespace softgrip::control {

std::string_view name_of(BindingLimit limit) noexcept {
  constexpr std::array<std::string_view, 6> names{"none",         "rig_pressure", "step_pressure",
                                                  "step_squeeze", "rig_slew_up",  "rig_slew_down"};
  return names[static_cast<std::size_t>(limit)];
}

std::string_view words_of(BindingLimit limit) noexcept {
  constexpr std::array<std::string_view, 6> words{
      "",
      "pressure_max_kpa of the rig limits the pressure",
      "pressure_max_kpa of the step limits the pressure",
      "squeeze_max_kpa of the step limits the pressure",
      "slew_up_kpa_per_s of the rig limits the rate of the pressure",
      "slew_down_kpa_per_s of the rig limits the rate of the pressure"};
  return words[static_cast<std::size_t>(limit)];
}

std::optional<BindingLimit> LimitWatch::observe(double time_s, BindingLimit now) noexcept {
  if (now != BindingLimit::none) {
    if (now_ == BindingLimit::none) since_s_ = time_s;
    if (now_ != now) change_s_ = time_s;
    now_ = now;
    last_s_ = time_s;
  } else if (now_ != BindingLimit::none && time_s - last_s_ > gap_s) {
    now_ = BindingLimit::none;
  }
  const bool none_reported = reported_ == BindingLimit::none;
  const bool binds = now_ != BindingLimit::none && now_ != reported_ &&
                     time_s - (none_reported ? since_s_ : change_s_) >= moment_s;
  if (binds) return reported_ = now_;
  if (now_ == BindingLimit::none && !none_reported) return reported_ = BindingLimit::none;
  return std::nullopt;
}

}  // namespace softgrip::control
