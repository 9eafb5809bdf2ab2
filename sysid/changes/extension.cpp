#include "sysid/changes/extension.h"

#include <algorithm>
#include <cmath>

#include "base/interpolation.h"
#include "model/blocks/transport_delay.h"
#include "model/chain.h"
#include "model/named.h"
#include "sysid/fitting/trajectory_walk.h"

namespace softgrip::sysid {

std::vector<double> drive_behind(const std::vector<model::BlockSpec>& valve, const Record& record) {
  if (valve.empty()) return record.drive_kpa;
  model::Model model;
  for (const model::BlockSpec& block : valve) model = model::with_block(std::move(model), block);
  model::Chain<double> chain(model, {}, record.sample_time_s);
  start<double>(chain, record, 0);
  std::vector<double> out(record.size(), chain.pressure_kpa());
  for (std::size_t i = 1; i < record.size(); ++i) {
    const model::Surroundings around = surroundings_at(record, i);
    const double end = drive_at_end(record, i);
    if (record.held) chain.step(0, end, around);
    chain.step(record.duration_s[i], end, around);
    out[i] = chain.pressure_kpa();
  }
  return out;
}

std::optional<model::Model> with_valve(model::Model model, const std::vector<model::BlockSpec>& valve) {
  for (const model::BlockSpec& block : valve) {
    const auto own = std::find_if(model.blocks.begin(), model.blocks.end(),
                                  [&](const model::BlockSpec& b) { return b.type == block.type; });
    if (own == model.blocks.end())
      model = model::with_block(std::move(model), block);
    else if (*own == model::neutral_block(own->type))
      own->values = block.values;
    else if (model::is<model::TransportDelay>(block))
      own->values[0] += block.values[0];
    else
      return std::nullopt;
  }
  return model;
}

std::vector<double> softened(const Softening& softening, const Record& record, double largest_kpa) {
  double most_kpa = record.largest_before_kpa;
  std::vector<double> factor(record.size());
  for (std::size_t i = 0; i < record.size(); ++i) {
    most_kpa = std::max(most_kpa, std::abs(record.drive_kpa[i]));
    const double below_kpa = most_kpa - std::abs(record.drive_kpa[i]);
    const double part = softening.range_kpa > 0 ? std::tanh(below_kpa / softening.range_kpa) : 1;
    factor[i] = 1 + softening.share * most_kpa / largest_kpa * part;
  }
  return factor;
}

std::vector<double> added_by(const Crescent& crescent, const Record& record, double largest_kpa) {
  double between = 0;
  std::vector<double> added(record.size());
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double down = std::abs(record.drive_kpa[i]) / largest_kpa;
    const double up = std::pow(down, crescent.exponent);
    between = std::clamp(between, std::min(up, down), std::max(up, down));
    added[i] = crescent.share * (between - 0.5 * (up + down));
  }
  return added;
}

std::vector<double> leading_by(double lead_s, const Record& record, const std::vector<double>& series) {
  std::vector<double> later_s = record.time_s;
  for (double& s : later_s) s += lead_s;
  return interpolated(record.time_s, series, later_s);
}

std::vector<double> pressure_behind(const SlowLine& line, const PressureLoss& loss, const Record& record,
                                    std::vector<double> pressure_kpa) {
  if (line.filling_s > 0 || line.venting_s > 0) {
    double p = pressure_kpa.front();
    for (std::size_t i = 1; i < pressure_kpa.size(); ++i) {
      const double tau_s = pressure_kpa[i] > p ? line.filling_s : line.venting_s;
      p += (pressure_kpa[i] - p) * (tau_s > 0 ? -std::expm1(-record.duration_s[i] / tau_s) : 1);
      pressure_kpa[i] = p;
    }
  }
  if (loss.rate_kpa_per_s == 0) return pressure_kpa;
  double lost = 0;
  for (std::size_t i = 1; i < pressure_kpa.size(); ++i) {
    const double dt = record.duration_s[i];
    const double way = std::abs(record.drive_kpa[i] - record.drive_kpa[i - 1]);
    lost += dt * loss.rate_kpa_per_s * pressure_kpa[i] / record.largest_kpa;
    lost *= std::exp(-dt / loss.recovery_s - way / loss.way_kpa);
    pressure_kpa[i] -= lost;
  }
  return pressure_kpa;
}

}  // namespace softgrip::sysid
