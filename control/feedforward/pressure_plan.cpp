#include "control/feedforward/pressure_plan.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "model/chain.h"

namespace softgrip::control {

double PressurePlan::at(double time_s) const noexcept {
  if (pressure_kpa.empty()) return 0;
  const double place = (time_s - start_s) / step_s;
  if (!(place > 0)) return pressure_kpa.front();
  const auto whole = static_cast<std::size_t>(place);
  if (whole + 1 >= pressure_kpa.size()) return pressure_kpa.back();
  const double share = place - static_cast<double>(whole);
  return pressure_kpa[whole] + share * (pressure_kpa[whole + 1] - pressure_kpa[whole]);
}

double PressurePlan::miss_mm(double time_s) const noexcept {
  if (displacement_mm.empty()) return 0;
  const double last = static_cast<double>(displacement_mm.size() - 1);
  const double place = std::round(std::clamp((time_s - start_s) / step_s, 0.0, last));
  return std::abs(displacement_mm[static_cast<std::size_t>(place)] -
                  reference.value_at(start_s + place * step_s));
}

SettledLine settled_line(const model::Model& model, const LimitSettings& limits) {
  model::Chain<double> chain(without_dead_time(model));
  SettledLine line;
  line.lowest_kpa = limits.pressure_min_kpa;
  chain.reset(limits.pressure_min_kpa);
  line.at_lowest_mm = chain.after(model::Station::load);
  chain.reset(limits.pressure_max_kpa);
  line.gain_mm_per_kpa = (chain.after(model::Station::load) - line.at_lowest_mm) /
                         (limits.pressure_max_kpa - limits.pressure_min_kpa);
  return line;
}

model::Model without_dead_time(const model::Model& model) {
  return model::only(model, [](const model::BlockInfo& info) {
    return info.station != model::Station::sensor && info.inverse != model::Inverse::preview &&
           info.inverse != model::Inverse::play && info.inverse != model::Inverse::ignored;
  });
}

}  // namespace softgrip::control
