#include "sysid/fitting/fit_space.h"

#include <algorithm>
#include <cmath>

#include "model/blocks/bouc_wen.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/named.h"
#include "model/parameter.h"
#include "sysid/fitting/trajectory.h"

namespace softgrip::sysid {
namespace {

/// Returns true for a stiffness or a damping. Such a parameter is positive, spans several decades, and has no
/// effect if it is very large.
bool is_logarithmic(const model::ParameterSpec& spec) {
  return spec.lower >= 0 && spec.neutral >= 1e6;
}

/// Returns the unsettled creep of a branch [mm]. It is 0 if the start state was estimated for a model without
/// this branch.
double unsettled_mm(const StartState& start, std::size_t branch) {
  return branch < start.unsettled_mm.size() ? start.unsettled_mm[branch] : 0;
}

/// Largest dead time, lag or period that a fit permits, in units of time_unit_s().
constexpr double largest_latency = 10;

/// Largest magnitude of a gain or of a rate per kPa that a fit permits, in units of displacement_unit_mm() /
/// pressure_unit_kpa() for a gain, and in units of 1 / pressure_unit_kpa() for a rate.
/// The readings cannot distinguish a larger rate from a jump of the displacement.
constexpr double largest_per_pressure = 10;

struct FitUnits {
  double time_s, pressure_kpa, displacement_mm;
};

FreeParameter model_parameter(const model::Model& model, std::size_t flat_index, const FitUnits& units) {
  const model::ParameterSpec& spec = model::parameter_spec(model, flat_index);
  FreeParameter p;
  p.flat_index = flat_index;
  p.name = model::parameter_path(model, flat_index);
  p.unit = model::in_unit(spec.unit, model.output_unit);
  p.logarithmic = is_logarithmic(spec);
  p.scale = p.logarithmic ? 1 : spec.scale;
  p.lower = p.logarithmic ? std::max(spec.lower, 1e-9) : spec.lower;
  // The lower bound of this parameter is above 0. A chain may skip a block whose parameter is 0, and the
  // derivative with respect to this parameter would then be 0.
  if (spec.lower == 0 && spec.neutral == 0) p.lower = 1e-6 * spec.scale;
  p.upper = spec.upper;
  if (spec.latency) {
    p.scale = spec.scale * units.time_s;
    p.upper = std::min(spec.upper, largest_latency * units.time_s);
  }
  if (spec.per_pressure) {
    const bool gain = spec.unit.starts_with("mm");
    const double unit = (gain ? units.displacement_mm : 1.0) / units.pressure_kpa;
    const double largest = largest_per_pressure * unit;
    p.scale = spec.scale * unit;
    if (gain) p.lower *= std::min(1.0, units.displacement_mm);
    p.lower = std::max(p.lower, -largest);
    p.upper = std::min(spec.upper, largest);
  }
  return p;
}

/// Returns true if the play operators have envelopes. Without envelopes, the envelope parameters have no
/// effect.
bool has_envelopes(const model::BlockSpec& plays) {
  return plays.values[model::parameter_index<model::PrandtlIshlinskii>("envelope_kpa")] > 0;
}

}  // namespace

bool is_movable(const model::Model& model, std::size_t flat_index) {
  const model::ParameterSpec& spec = model::parameter_spec(model, flat_index);
  if (spec.whole || spec.placed) return false;
  const model::ParameterPlace place = model::place_of(model, flat_index);
  if (spec.name == "envelope_bend" || spec.name == "envelope_skew")
    return has_envelopes(model.blocks[place.block]);
  const bool is_k0 = model::is<model::KelvinVoigt>(model.blocks[place.block]) && place.value == 0;
  return !is_k0 ||
         !(model::position_of<model::BoucWen>(model) || model::position_of<model::PrandtlIshlinskii>(model));
}

double FreeParameter::to_z(double value) const {
  return logarithmic ? std::log(std::max(value, 1e-300)) : value / scale;
}
double FreeParameter::to_value(double z) const {
  return logarithmic ? std::exp(z) : z * scale;
}
double FreeParameter::slope(double z) const {
  return logarithmic ? std::exp(z) : scale;
}

FitSpace::FitSpace(const model::Model& model, const std::vector<Record>& records,
                   const std::vector<std::size_t>& free_flat)
    : base_(model), base_starts_(rest_starts(model, records)) {
  const FitUnits units{time_unit_s(records), pressure_unit_kpa(records), displacement_unit_mm(records)};
  for (const std::size_t index : free_flat) free_.push_back(model_parameter(model, index, units));
  const std::size_t branches = creep_branches(model).size();
  for (std::size_t r = 0; r < records.size(); ++r) {
    const Record& record = records[r];
    const auto add = [&](FreeParameter::Kind kind, std::size_t branch, const std::string& name,
                         std::string unit, double scale, double lower, double upper) {
      FreeParameter p;
      p.kind = kind;
      p.record = r;
      p.branch = branch;
      p.name = record.name + ": " + name;
      p.unit = std::move(unit);
      p.scale = scale;
      p.lower = lower;
      p.upper = upper;
      free_.push_back(std::move(p));
    };
    const double scale_mm = std::max(record.span_mm, 1e-3);
    const std::string reading_unit(model::name_of(record.output_unit));
    if (record.offset_free)
      add(FreeParameter::Kind::offset, 0, "offset_mm", reading_unit, scale_mm, -1e6, 1e6);
    if (!record.start_unknown) continue;
    const double first = record.drive_kpa.front() + 1e-6;
    add(FreeParameter::Kind::peak_before, 0, "peak_before_kpa", "kPa", record.largest_kpa, first,
        std::max(first + 1e-6, 1.5 * record.largest_kpa));
    for (std::size_t b = 0; b < branches; ++b) {
      add(FreeParameter::Kind::unsettled, b, "unsettled" + std::to_string(b + 1) + "_mm", reading_unit,
          scale_mm, -2 * scale_mm, 2 * scale_mm);
    }
  }
}

void FitSpace::hold_starts(const std::vector<StartState>& starts) {
  std::erase_if(free_, [](const FreeParameter& p) { return p.kind != FreeParameter::Kind::model; });
  base_starts_ = starts;
}

void FitSpace::hold_arrivals(const std::vector<StartState>& starts) {
  for (std::size_t r = 0; r < starts.size(); ++r) {
    base_starts_[r].valley_before_kpa = starts[r].valley_before_kpa;
    base_starts_[r].arrival_kpa_per_s = starts[r].arrival_kpa_per_s;
  }
}

void FitSpace::bound(std::size_t index, double lower, double upper) {
  free_[index].lower = std::max(free_[index].lower, lower);
  free_[index].upper = std::min(free_[index].upper, upper);
}

FitPoint FitSpace::point(std::span<const double> z) const {
  FitPoint point{base_, base_starts_};
  std::vector<double> values = model::flat_values(base_);
  for (std::size_t i = 0; i < free_.size(); ++i) {
    const FreeParameter& p = free_[i];
    const double value = std::clamp(p.to_value(z[i]), p.lower, p.upper);
    switch (p.kind) {
      case FreeParameter::Kind::model:
        values[p.flat_index] = value;
        break;
      case FreeParameter::Kind::offset:
        point.starts[p.record].offset_mm = value;
        break;
      case FreeParameter::Kind::peak_before:
        point.starts[p.record].peak_before_kpa = value;
        break;
      case FreeParameter::Kind::unsettled:
        point.starts[p.record].unsettled_mm[p.branch] = value;
        break;
    }
  }
  point.model = model::with_values(std::move(point.model), values);
  return point;
}

std::vector<double> FitSpace::z(const FitPoint& point) const {
  std::vector<double> z(free_.size());
  for (std::size_t i = 0; i < free_.size(); ++i) {
    z[i] = free_[i].to_z(std::clamp(value(point, i), free_[i].lower, free_[i].upper));
  }
  return z;
}

double FitSpace::value(const FitPoint& point, std::size_t index) const {
  const FreeParameter& p = free_[index];
  switch (p.kind) {
    case FreeParameter::Kind::offset:
      return point.starts[p.record].offset_mm;
    case FreeParameter::Kind::peak_before:
      return point.starts[p.record].peak_before_kpa;
    case FreeParameter::Kind::unsettled:
      return unsettled_mm(point.starts[p.record], p.branch);
    case FreeParameter::Kind::model:
      break;
  }
  const model::ParameterPlace place = model::place_of(point.model, p.flat_index);
  return point.model.blocks[place.block].values[place.value];
}

std::vector<StartState> rest_starts(const model::Model& model, const std::vector<Record>& records) {
  std::vector<StartState> starts(records.size());
  const std::size_t branches = creep_branches(model).size();
  for (std::size_t r = 0; r < records.size(); ++r) {
    const double first = records[r].drive_kpa.front();
    // If the peak is unknown, the search starts with a peak halfway between the first and the largest
    // pressure. A start at the first pressure is unsuitable, because the derivative with respect to the peak
    // is 0 there.
    starts[r].peak_before_kpa = records[r].start_unknown ? (first + records[r].largest_kpa) / 2 : first;
    starts[r].unsettled_mm.assign(branches, 0);
  }
  return starts;
}

}  // namespace softgrip::sysid
