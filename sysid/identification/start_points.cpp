#include "sysid/identification/start_points.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "model/blocks/bouc_wen.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_lag.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/identification/identify.h"

namespace softgrip::sysid {
namespace {

class Drawer {
 public:
  Drawer(const FitSpace& space, const std::vector<Record>& records, std::uint64_t seed)
      : space_(space), scale_(campaign_size(records)), time_unit_s_(time_unit_s(records)), random_(seed) {}

  /// Draws a random point around `given`. A stiffness or damping typically changes by a factor of about two.
  /// Any other model parameter typically changes by the larger of two amounts: 70 % of the value, or 35 % of
  /// its scale in the fit. A pressure peak before a record is drawn uniformly from its range.
  FitPoint around(const FitPoint& given) {
    std::vector<double> z = space_.z(given);
    for (std::size_t i = 0; i < z.size(); ++i) {
      const FreeParameter& p = space_.free()[i];
      if (p.kind == FreeParameter::Kind::peak_before) z[i] = uniform(p.lower_z(), p.upper_z());
      if (p.kind != FreeParameter::Kind::model) continue;
      z[i] += 0.7 * normal_(random_) * (p.logarithmic ? 1 : std::max(std::abs(z[i]), 0.5));
      z[i] = std::clamp(z[i], p.lower_z(), p.upper_z());
    }
    return valid(space_.point(z), given);
  }

  /// Draws a random point at the scale of the data. The scale determines the parameters of Bouc-Wen,
  /// Kelvin-Voigt, delay and lag. The parameters of other blocks are drawn as in around().
  FitPoint from_scale(const FitPoint& given) {
    FitPoint point = around(given);
    const double gain = scale_.span_mm / scale_.largest_kpa;
    for (model::BlockSpec& block : point.model.blocks) {
      std::vector<double>& v = block.values;
      if (model::is<model::BoucWen>(block)) {
        const double growing = between(0.5, 8) / scale_.largest_kpa;
        const double eta = growing * uniform(0.2, 0.9);
        v[0] = gain * uniform(0.2, 1);
        v[1] = v[0] * uniform(0.2, 1);
        v[2] = growing - eta;
        v[3] = eta;
      } else if (model::is<model::KelvinVoigt>(block)) {
        branches(gain, v);
      } else if (model::is<model::TransportDelay>(block) || model::is<model::ValveLag>(block)) {
        v[0] = time_unit_s_ * uniform(0.005, 0.3);
      }
    }
    // Converts the point to the coordinates of the fit and back. This conversion resets all parameters that
    // are not fitted to their given values.
    return valid(space_.point(space_.z(point)), given);
  }

 private:
  double uniform(double lower, double upper) {
    return std::uniform_real_distribution<double>(lower, upper)(random_);
  }
  double between(double lower, double upper) { return std::exp(uniform(std::log(lower), std::log(upper))); }

  /// Draws time constants of creep branches, up to half the length of the longest log. If the time constants
  /// of the given model increase from branch to branch, the drawn ones increase too; otherwise they decrease.
  void branches(double gain, std::vector<double>& v) {
    const std::size_t count = (v.size() - 1) / 2;
    std::vector<double> time_constants;
    for (std::size_t b = 0; b < count; ++b)
      time_constants.push_back(between(0.05 * time_unit_s_, scale_.longest_s / 2));
    std::sort(time_constants.begin(), time_constants.end(), std::greater<>());
    const bool rising = count > 1 && v[2] / v[1] < v[4] / v[3];
    if (rising) std::reverse(time_constants.begin(), time_constants.end());
    for (std::size_t b = 0; b < count; ++b) {
      v[1 + 2 * b] = static_cast<double>(count) / (gain * uniform(0.1, 1));
      v[2 + 2 * b] = v[1 + 2 * b] * time_constants[b];
    }
  }

  static FitPoint valid(const FitPoint& point, const FitPoint& given) {
    return model::validate(point.model).empty() ? point : given;
  }

  const FitSpace& space_;
  CampaignSize scale_;
  double time_unit_s_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace

CampaignSize campaign_size(const std::vector<Record>& records) {
  CampaignSize extent;
  for (const Record& record : records) {
    extent.largest_kpa = std::max(extent.largest_kpa, record.largest_kpa);
    extent.span_mm = std::max(extent.span_mm, record.span_mm);
    extent.longest_s = std::max(extent.longest_s, record.length_s());
  }
  return extent;
}

std::vector<FitPoint> draw_starts(const FitSpace& space, const FitPoint& given,
                                  const std::vector<Record>& records, std::size_t count, std::uint64_t seed) {
  std::vector<FitPoint> starts{given};
  for (std::size_t i = 1; i < count; ++i) {
    // Every start point has its own seed, so that the first 10 of 20 start points equal the start points of a
    // search with 10 start points.
    std::seed_seq sequence{seed, static_cast<std::uint64_t>(i)};
    std::vector<std::uint64_t> derived(1);
    sequence.generate(derived.begin(), derived.end());
    Drawer drawer(space, records, derived.front());
    starts.push_back(i % 2 == 1 ? drawer.from_scale(given) : drawer.around(given));
  }
  return starts;
}

model::Model base_model(const std::vector<Log>& logs, std::size_t branches) {
  return base_model(make_records(logs, {}), branches);
}

model::Model base_model(const std::vector<Record>& records, std::size_t branches) {
  const CampaignSize scale = campaign_size(records);
  const double gain = scale.span_mm / std::max(scale.largest_kpa, 1e-6);
  model::Model model;
  model.name = "identified";
  if (!records.empty()) model.output_unit = records.front().output_unit;
  model.source = "start values from the scale of the data";
  const double saturation_per_kpa = 1 / std::max(scale.largest_kpa, 1e-6);
  model = model::with_block(std::move(model),
                            {model::block_type<model::BoucWen>(),
                             {0.6 * gain, 0.3 * gain, saturation_per_kpa, saturation_per_kpa, 1}});
  // The spring k0 is practically rigid, so alpha alone is the instantaneous gain. The data determine only the
  // sum alpha + 1/k0.
  std::vector<double> creep{1e9};
  const double slowest = std::max(scale.longest_s / 4, 1.0);
  for (std::size_t b = 0; b < branches; ++b) {
    const double share = branches > 1 ? static_cast<double>(b) / static_cast<double>(branches - 1) : 0.5;
    const double time_constant = slowest * std::pow(0.4 / slowest, share);
    const double stiffness = static_cast<double>(branches) / (0.4 * gain);
    creep.insert(creep.end(), {stiffness, stiffness * time_constant});
  }
  return model::with_block(std::move(model), {model::block_type<model::KelvinVoigt>(), std::move(creep)});
}

}  // namespace softgrip::sysid
