#include "control/feedforward/valve_inverse.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "control/elements/lag_share.h"
#include "control/feedforward/running_model.h"
#include "model/blocks/pressure_regulator.h"
#include "model/blocks/valve_deadband.h"
#include "model/catalogue.h"
#include "model/named.h"

namespace softgrip::control {
namespace {

bool lags(const model::BlockSpec& block) {
  return model::catalogue()[block.type].info.inverse == model::Inverse::lead;
}

/// Returns the sum of the time constants of all lags of the valve, for filling or for venting [s].
double time_constants_s(const model::Model& valve, std::string_view direction) {
  double sum = 0;
  for (const model::BlockSpec& block : valve.blocks) {
    if (!lags(block)) continue;
    const auto own = model::find_parameter(block, direction);
    const auto both = model::find_parameter(block, "time_constant_s");
    if (own || both) sum += block.values[own ? *own : *both];
  }
  return sum;
}

/// Returns half of the dead band that precedes the first lag [kPa]; 0 if no dead band precedes the first lag.
double half_band_kpa(const model::Model& valve) {
  const auto first = std::ranges::find_if(valve.blocks, [](const model::BlockSpec& block) {
    return lags(block) || model::is<model::ValveDeadband>(model::catalogue()[block.type].info);
  });
  if (first == valve.blocks.end() || lags(*first)) return 0;
  return 0.5 * first->values[model::find_parameter(*first, "band_kpa").value()];
}

}  // namespace

ValveInverse::ValveInverse(const model::Model& model, double tick_s) : tick_s_(tick_s) {
  const model::Model valve = valve_of(model);
  half_band_kpa_ = half_band_kpa(valve);
  for (auto [lag, name] :
       {std::pair{&filling_, "filling_time_constant_s"}, {&venting_, "venting_time_constant_s"}}) {
    lag->time_constant_s = time_constants_s(valve, name);
    lag->share = lag_share(tick_s, lag->time_constant_s);
  }
  const model::Chain<double> chain(valve, {}, tick_s);
  const auto* regulator = chain.find<model::PressureRegulator<double>>();
  if (regulator != nullptr && std::ranges::count_if(valve.blocks, lags) == 1)
    regulator_.emplace(regulator->regulated(), tick_s);
}

void ValveInverse::take_over(const model::Chain<double>& valve) noexcept {
  if (half_band_kpa_ > 0) behind_band_kpa_ = valve.find<model::ValveDeadband<double>>()->output();
  if (regulator_) regulator_->take_over(valve.find<model::PressureRegulator<double>>()->regulated());
}

double ValveInverse::command_for(double now_kpa, double next_kpa) const noexcept {
  const Lag& lag = lag_towards(now_kpa, next_kpa);
  const double behind_kpa = regulator_                ? regulator_->command_for(next_kpa)
                            : lag.time_constant_s > 0 ? now_kpa + (next_kpa - now_kpa) / lag.share
                                                      : 0.5 * (now_kpa + next_kpa);
  return behind_kpa + direction_of(behind_kpa - behind_band_kpa_, tick_s_) * half_band_kpa_;
}

double ValveInverse::advance(double now_kpa, double command_kpa) noexcept {
  behind_band_kpa_ = std::clamp(behind_band_kpa_, command_kpa - half_band_kpa_, command_kpa + half_band_kpa_);
  if (regulator_) return regulator_->advance(behind_band_kpa_);
  const Lag& lag = lag_towards(now_kpa, behind_band_kpa_);
  return lag.time_constant_s > 0 ? now_kpa + lag.share * (behind_band_kpa_ - now_kpa)
                                 : 2 * behind_band_kpa_ - now_kpa;
}

}  // namespace softgrip::control
