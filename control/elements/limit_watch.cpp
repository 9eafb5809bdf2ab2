#include "control/elements/limit_watch.h"

#include <array>
#include <cstddef>

namespace softgrip::control {

std::string_view name_of(UpperLimit limit) noexcept {
  constexpr std::array<std::string_view, 4> names{"none", "rig_pressure", "step_pressure", "step_squeeze"};
  return names[static_cast<std::size_t>(limit)];
}

std::optional<UpperLimit> LimitWatch::observe(double time_s, UpperLimit now) noexcept {
  if (now != UpperLimit::none) {
    if (now_ == UpperLimit::none) since_s_ = time_s;
    now_ = now;
    last_s_ = time_s;
  } else if (now_ != UpperLimit::none && time_s - last_s_ > gap_s) {
    now_ = UpperLimit::none;
  }
  const bool binds = now_ != UpperLimit::none && time_s - since_s_ >= moment_s;
  if (binds && told_ == UpperLimit::none) return told_ = now_;
  if (now_ == UpperLimit::none && told_ != UpperLimit::none) return told_ = UpperLimit::none;
  return std::nullopt;
}

}  // namespace softgrip::control
