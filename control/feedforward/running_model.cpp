#include "control/feedforward/running_model.h"

#include <algorithm>
#include <cmath>

namespace softgrip::control {
namespace {

using model::BlockInfo;
using model::Inverse;
using model::Station;

bool runs(const BlockInfo& info) {
  return info.inverse != Inverse::preview && info.inverse != Inverse::ignored;
}

/// Returns true for a valve block that is not inverted together with the finger. Valve blocks with
/// Inverse::implicit, such as a leak, are inverted together with the finger.
bool is_of_valve(const BlockInfo& info) {
  return info.station == Station::valve && info.inverse != Inverse::implicit;
}

}  // namespace

double dead_time_s(const model::Model& model) {
  double sum = 0;
  for (const model::BlockSpec& block : model.blocks) {
    if (model::catalogue()[block.type].info.inverse != Inverse::preview) continue;
    sum += block.values[model::find_parameter(block, "delay_s").value()];
  }
  return sum;
}

model::Model valve_of(const model::Model& model) {
  return model::only(model, [](const BlockInfo& info) { return is_of_valve(info) && runs(info); });
}

model::Model body_of(const model::Model& model) {
  return model::only(model, [](const BlockInfo& info) { return !is_of_valve(info) && runs(info); });
}

RunningModel::RunningModel(const model::Model& model, double tick_s, double extra_latency_s,
                           double longest_age_s)
    : tick_s_(tick_s),
      ahead_s_(dead_time_s(model) + extra_latency_s),
      has_valve_(!valve_of(model).blocks.empty()),
      valve_(valve_of(model), {}, tick_s),
      body_(body_of(model), {}, tick_s),
      past_mm_(static_cast<std::size_t>(std::ceil((ahead_s_ + longest_age_s) / tick_s)) + 2),
      past_kpa_(past_mm_.size()) {
  reset(0);
}

void RunningModel::reset(double command_kpa) noexcept {
  valve_.reset(command_kpa);
  pressure_kpa_ = has_valve_ ? valve_.pressure_kpa() : command_kpa;
  body_.reset(pressure_kpa_);
  std::fill(past_mm_.begin(), past_mm_.end(), body_.reading_mm());
  std::fill(past_kpa_.begin(), past_kpa_.end(), pressure_kpa_);
}

void RunningModel::advance(double command_kpa) noexcept {
  // The board holds its output for a tick, so the command jumps at the start of the tick and then stays
  // constant. Behind a lag, the pressure does not jump; it changes during the tick.
  double at_once = command_kpa;
  double at_end = command_kpa;
  if (has_valve_) {
    valve_.step(0, command_kpa);
    at_once = valve_.pressure_kpa();
    valve_.step(tick_s_, command_kpa);
    at_end = valve_.pressure_kpa();
  }
  if (at_once != pressure_kpa_) body_.step(0, at_once);
  body_.step(tick_s_, at_end);
  pressure_kpa_ = at_end;
  remember();
}

void RunningModel::remember() noexcept {
  newest_ = newest_ + 1 == past_mm_.size() ? 0 : newest_ + 1;
  past_mm_[newest_] = body_.reading_mm();
  past_kpa_[newest_] = pressure_kpa_;
}

double RunningModel::past(const std::vector<double>& ring, double age_s) const noexcept {
  const double oldest = static_cast<double>(ring.size() - 1);
  const double back = std::clamp((ahead_s_ + age_s) / tick_s_, 0.0, oldest);
  const auto whole = std::min(static_cast<std::size_t>(back), ring.size() - 2);
  const double fraction = back - static_cast<double>(whole);
  const std::size_t size = ring.size();
  const std::size_t later = newest_ >= whole ? newest_ - whole : newest_ + size - whole;
  const std::size_t earlier = later == 0 ? size - 1 : later - 1;
  return ring[later] + fraction * (ring[earlier] - ring[later]);
}

}  // namespace softgrip::control
