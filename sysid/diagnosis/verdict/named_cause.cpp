#include "sysid/diagnosis/verdict/named_cause.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include "base/statistics.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/diagnosis/causes/outliers.h"
#include "sysid/diagnosis/causes/sampling.h"
#include "sysid/diagnosis/residual/resolution.h"
#include "sysid/diagnosis/search/holdout.h"
#include "sysid/fitting/residuals.h"
#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Widens the interval of each parameter of `named`. The interval then includes the interval of the same
/// parameter in `with`. Returns true if at least one interval became wider.
bool widen(NamedCause& named, const std::vector<CauseParameter>& with) {
  bool wider = false;
  for (CauseParameter& number : named.parameters) {
    const auto same = std::find_if(with.begin(), with.end(),
                                   [&](const CauseParameter& p) { return p.name == number.name; });
    if (!number.has_interval || same == with.end() || !same->has_interval) continue;
    wider |= same->ci95.lower < number.ci95.lower || same->ci95.upper > number.ci95.upper;
    number.ci95 = {std::min(number.ci95.lower, same->ci95.lower),
                   std::max(number.ci95.upper, same->ci95.upper)};
  }
  return wider;
}

}  // namespace

UncertainPoint uncertain_point(const std::vector<Record>& records, const FitPoint& point,
                               const FitSpace& space) {
  const auto residuals = residuals_for(records, space);
  std::vector<double> z = space.z(point);
  Uncertainty uncertainty = uncertainty_at(*residuals, z, std::numeric_limits<double>::infinity());
  return {point, space, std::move(z), std::move(uncertainty)};
}

std::vector<CauseParameter> block_numbers(const UncertainPoint& at, std::size_t block_type) {
  std::vector<CauseParameter> list;
  const model::Model& model = at.point.model;
  const auto position = model::position_of(model, block_type);
  if (!position) return list;
  const model::BlockSpec& block = model.blocks[*position];
  for (std::size_t i = 0; i < block.values.size(); ++i) {
    CauseParameter p;
    const model::BlockDescriptor& descriptor = model::catalogue()[block.type];
    const model::ParameterSpec& spec = descriptor.spec(i);
    p.name = descriptor.name(i);
    p.formerly = descriptor.former_name(i);
    p.unit = model::in_unit(spec.unit, model.output_unit);
    p.value = block.values[i];
    for (std::size_t j = 0; j < at.space.size(); ++j) {
      const FreeParameter& free = at.space.free()[j];
      if (free.kind != FreeParameter::Kind::model || at.uncertainty.at_bound[j]) continue;
      const model::ParameterPlace place = model::place_of(model, free.flat_index);
      if (place.block != *position || place.value != i) continue;
      const double deviation = at.uncertainty.deviation(j);
      if (deviation == 0) continue;
      const double half = at.uncertainty.quantile * deviation;
      // A finite end of an interval is limited to the permitted range, because a delay, for example, is not
      // negative. An infinite end means that the value is unknown, so it is not limited.
      const auto possible = [&](double value) {
        return std::isfinite(value) ? std::clamp(value, spec.lower, spec.upper) : value;
      };
      p.ci95 = {possible(free.to_value(at.z[j] - half)), possible(free.to_value(at.z[j] + half))};
      p.has_interval = true;
    }
    list.push_back(std::move(p));
  }
  return list;
}

std::vector<NamedCause> name_chosen(const std::vector<Record>& records, const StructureFit& extended,
                                    const std::vector<ChosenCause>& chosen) {
  std::vector<NamedCause> list;
  if (chosen.empty()) return list;
  const model::Model& model = extended.point.model;
  const FitSpace space = structure_space(records, model, extended.causes);
  const UncertainPoint at = uncertain_point(records, extended.point, space);
  for (const ChosenCause& each : chosen) {
    const std::size_t type = model.blocks[*position_of(model, each.cause)].type;
    list.push_back({each, type, block_numbers(at, type), {}});
  }
  return list;
}

namespace {

/// Returns a cause that was detected in the readings before any fit.
/// @param excess_mm  root mean square error that the affected readings cause, > 0.
/// @param ci95_mm  95 % interval of `excess_mm`. Its ends are not negative.
NamedCause cause_in_readings(std::string_view id, std::vector<CauseParameter> parameters, double excess_mm,
                             const Interval& ci95_mm, double noise_mm) {
  NamedCause named;
  named.cause = *find_cause(id);
  named.block_type = named.cause.forms.front().type;
  named.parameters = std::move(parameters);
  const auto gain_percent = [noise_mm](double error_mm) {
    return error_mm > 0 ? 100 * (1 - noise_mm / std::hypot(noise_mm, error_mm)) : 0;
  };
  const double lower = gain_percent(ci95_mm.lower), upper = gain_percent(ci95_mm.upper);
  named.gain_percent = {gain_percent(excess_mm), (upper - lower) / (2 * limits::deviate), lower, upper};
  return named;
}

/// Returns the 95 % interval of OutlierEvidence::excess_mm. The interval of the size may begin at 0 if the
/// sizes differ much, but the root mean square of the sizes is not below the smallest size.
Interval excess_interval_mm(const OutlierEvidence& outliers) {
  double smallest_mm = outliers.size_mm;
  for (const double size_mm : outliers.sizes_mm) smallest_mm = std::min(smallest_mm, std::abs(size_mm));
  return {std::sqrt(outliers.share_low) * std::max(outliers.size_low_mm, smallest_mm),
          std::sqrt(outliers.share_high) * outliers.size_high_mm};
}

}  // namespace

std::vector<NamedCause> causes_in_readings(const OutlierEvidence& outliers, const SamplingEvidence& sampling,
                                           double noise_mm, model::OutputUnit unit) {
  std::vector<NamedCause> named;
  if (outliers.present) {
    named.push_back(cause_in_readings(
        causes::Outliers::id,
        {{"probability", "", outliers.share, {outliers.share_low, outliers.share_high}, true},
         {"size_mm",
          std::string(model::name_of(unit)),
          outliers.size_mm,
          {outliers.size_low_mm, outliers.size_high_mm},
          true}},
        outliers.excess_mm, excess_interval_mm(outliers), noise_mm));
  }
  if (sampling.present) {
    std::vector<CauseParameter> parameters;
    if (sampling.interval_s > 0) parameters.push_back({"interval_s", "s", sampling.interval_s, {}, false});
    if (sampling.frozen_s > 0) parameters.push_back({"frozen_s", "s", sampling.frozen_s, {}, false});
    if (sampling.step_mm > 0)
      parameters.push_back({"step_mm", std::string(model::name_of(unit)), sampling.step_mm, {}, false});
    const std::size_t wrong = sampling.step_mm > 0 ? sampling.readings : sampling.hidden;
    const double error_mm =
        sampling.excess_mm / std::sqrt(static_cast<double>(std::max<std::size_t>(1, wrong)));
    const double other_noise_mm =
        std::sqrt(std::max(0.0, square(noise_mm) - rounding_variance_mm2(sampling.step_mm)));
    named.push_back(cause_in_readings(causes::Sampling::id, std::move(parameters), sampling.excess_mm,
                                      {sampling.excess_mm - error_mm, sampling.excess_mm + error_mm},
                                      other_noise_mm));
  }
  return named;
}

std::string title_within(const Cause& cause) {
  std::string text(cause.title);
  if (!text.empty()) text.front() = static_cast<char>(std::tolower(static_cast<unsigned char>(text.front())));
  return text;
}

std::string alternative_title(const Cause& alternative, const std::vector<NamedCause>& named) {
  return (is_among(named, alternative) ? "a further " : "") + title_within(alternative);
}

bool is_among(const std::vector<NamedCause>& named, const Cause& cause) {
  return std::any_of(named.begin(), named.end(), [&](const NamedCause& one) { return one.cause == cause; });
}

bool any_alternatives(const std::vector<NamedCause>& causes) {
  return std::any_of(causes.begin(), causes.end(),
                     [](const NamedCause& c) { return !c.alternatives.empty(); });
}

std::vector<std::string> mix_intervals(std::vector<NamedCause>& named, const std::vector<Record>& records,
                                       const Selection& selection, std::uint64_t seed) {
  std::vector<std::string> sentences;
  for (const Confounded& other : selection.undecided) {
    if (winning_share(other.losses, selection.extended_losses, seed) < 1 - limits::probability) continue;
    const FitSpace space = structure_space(records, other.fit.point.model, other.fit.causes);
    const UncertainPoint at = uncertain_point(records, other.fit.point, space);
    std::string beside;
    for (NamedCause& cause : named) {
      if (!widen(cause, block_numbers(at, cause.block_type)) || !cause.cause.is_confounded_with(other.cause))
        continue;
      beside += (beside.empty() ? "" : " and ") + std::string(cause.cause.id);
    }
    if (!beside.empty()) {
      sentences.push_back("these logs do not determine whether " + std::string(other.cause.id) +
                          " is present in addition to " + beside + ", so the intervals cover both cases");
    }
  }
  return sentences;
}

}  // namespace softgrip::sysid
