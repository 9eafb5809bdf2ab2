#include "control/elements/limit_watch.h"

#include "base/enum_table.h"

namespace softgrip::control {

namespace {
struct LimitTexts {
  std::string_view name;
  std::string_view words;
};
constexpr auto limit_texts = enum_table<BindingLimit, LimitTexts>({
    {BindingLimit::none, {"none", ""}},
    {BindingLimit::rig_pressure, {"rig_pressure", "pressure_max_kpa of the rig limits the pressure"}},
    {BindingLimit::step_pressure, {"step_pressure", "pressure_max_kpa of the step limits the pressure"}},
    {BindingLimit::step_squeeze, {"step_squeeze", "squeeze_max_kpa of the step limits the pressure"}},
    {BindingLimit::rig_slew_up,
     {"rig_slew_up", "slew_up_kpa_per_s of the rig limits the rate of the pressure"}},
    {BindingLimit::rig_slew_down,
     {"rig_slew_down", "slew_down_kpa_per_s of the rig limits the rate of the pressure"}},
});
}  // namespace

std::string_view name_of(BindingLimit limit) noexcept {
  return limit_texts[limit].name;
}
std::string_view words_of(BindingLimit limit) noexcept {
  return limit_texts[limit].words;
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
