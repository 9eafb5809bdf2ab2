#include "sysid/structure/structure.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/enum_table.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/linear_modes.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "sysid/fitting/score.h"

namespace softgrip::sysid {
namespace {

/// Lower limit of the instantaneous elastic gain, as a share of (displacement range / largest pressure).
constexpr double least_elastic_share = 0.01;
/// Ratio of consecutive time constants of the creep branches.
constexpr double ladder_ratio = 3;
/// Limits of linear modes: shortest period in sampling intervals (the Nyquist period is 2), and longest
/// period in units of time_unit_s().
constexpr double shortest_mode_in_intervals = 4, longest_mode_in_units = 10;

}  // namespace

std::string_view name_of(HysteresisForm form) {
  return form == HysteresisForm::play ? model::PrandtlIshlinskii<double>::info.id
                                      : model::BoucWen<double>::info.id;
}

std::string_view name_of(const BaseStructure& structure) {
  return structure.linear ? model::LinearModes<double>::info.id : name_of(structure.hysteresis);
}

std::string description_of(const BaseStructure& s) {
  if (s.published) {
    return s.lag ? "Bouc-Wen, two Kelvin-Voigt branches, delay and lag"
                 : "Bouc-Wen, two Kelvin-Voigt branches";
  }
  std::string text = s.linear                               ? "linear gain"
                     : !s.hysteretic                        ? "elastic gain"
                     : s.envelopes                          ? "generalised play operators"
                     : s.hysteresis == HysteresisForm::play ? "play operators"
                                                            : "Bouc-Wen";
  if (s.creep) text += s.slow_creep ? ", creep ladder" : ", creep ladder without slow branches";
  if (s.hinged_creep) text += ", pressure-dependent creep";
  if (s.modes > 0) text += ", " + std::to_string(s.modes) + (s.modes > 1 ? " linear modes" : " linear mode");
  if (s.delay) text += ", delay";
  if (s.lag && s.regulator) text += ", regulator with overlap";
  if (s.lag && !s.regulator) text += s.two_way ? ", lag (filling and venting)" : ", lag";
  if (s.lag && s.second_lag && !s.regulator) text += ", second lag";
  if (s.lag && s.rate_limit && !s.regulator) text += ", rate limit";
  if (s.characteristic) text += ", characteristic";
  if (s.resonance) text += ", resonance";
  return text;
}

double least_elastic_mm_per_kpa(const StructureGrid& grid) {
  return least_elastic_share * grid.span_mm / grid.largest_kpa;
}

double longest_mode_s(const StructureGrid& grid) {
  return std::min(longest_mode_in_units * grid.time_unit_s, 1e6);  // 1e6 s: limit of the block
}

StructureGrid grid_for(const std::vector<Record>& records) {
  StructureGrid grid;
  grid.time_unit_s = time_unit_s(records);
  grid.shortest_period_s = std::numeric_limits<double>::infinity();
  double longest_s = 0;
  std::size_t cycles = 0;
  for (const Record& record : records) {
    grid.shortest_period_s =
        std::min(grid.shortest_period_s, shortest_mode_in_intervals * record.mean_interval_s());
    grid.largest_kpa = std::max(grid.largest_kpa, record.largest_kpa);
    grid.span_mm = std::max(grid.span_mm, record.span_mm);
    longest_s = std::max(longest_s, record.length_s());
    cycles += cycle_starts(record).size();
  }
  const int plays = cycles > 2 ? 12 : 6;
  for (int i = 1; i <= plays; ++i)
    grid.thresholds_kpa.push_back(0.95 * std::pow(static_cast<double>(i) / plays, 1.5) * grid.largest_kpa);
  for (double tau = 0.05 * grid.time_unit_s; tau < 3 * longest_s && grid.ladder_s.size() < 10;
       tau *= ladder_ratio)
    grid.ladder_s.push_back(tau);
  grid.slow_from_s = longest_s / 10;
  grid.hinges_kpa = {0.25 * grid.largest_kpa, 0.5 * grid.largest_kpa, 0.75 * grid.largest_kpa};
  for (double tau = 0.25 * grid.time_unit_s; tau < longest_s && grid.hinge_ladder_s.size() < 5; tau *= 5)
    grid.hinge_ladder_s.push_back(tau);
  return grid;
}

std::string_view name_of(Ingredient ingredient) {
  static constexpr auto names =
      enum_names<Ingredient>({{Ingredient::hysteresis, "hysteresis"},
                              {Ingredient::play_operators, "play operators (replaced by Bouc-Wen)"},
                              {Ingredient::creep, "creep"},
                              {Ingredient::slow_creep, "slow creep"},
                              {Ingredient::pressure_dependent_creep, "dependence of creep on pressure"},
                              {Ingredient::delay, "delay"},
                              {Ingredient::lag, "lag"},
                              {Ingredient::second_lag, "a second lag"},
                              {Ingredient::rate_limit, "a rate limit"},
                              {Ingredient::latency, "delay and lag"},
                              {Ingredient::regulator, "a regulator with overlap (replaced by a lag)"},
                              {Ingredient::venting_lag, "a separate time constant for venting"},
                              {Ingredient::characteristic, "nonlinear characteristic and envelopes"},
                              {Ingredient::resonance, "a resonance"},
                              {Ingredient::linear_modes, "linear modes"},
                              {Ingredient::envelopes, "nonlinear envelopes"}});
  return names[ingredient];
}

BaseStructure without(BaseStructure s, Ingredient ingredient) {
  switch (ingredient) {
    case Ingredient::hysteresis:
      s.hysteretic = s.envelopes = false;
      break;
    case Ingredient::play_operators:
      if (!s.hysteretic) break;
      s.hysteresis = HysteresisForm::bouc_wen;
      s.envelopes = false;
      break;
    case Ingredient::creep:
      s.creep = s.hinged_creep = false;
      break;
    case Ingredient::slow_creep:
      s.slow_creep = false;
      break;
    case Ingredient::pressure_dependent_creep:
      s.hinged_creep = false;
      break;
    case Ingredient::delay:
      s.delay = false;
      break;
    case Ingredient::lag:
      s.lag = s.second_lag = s.rate_limit = false;
      break;
    case Ingredient::second_lag:
      s.second_lag = false;
      break;
    case Ingredient::rate_limit:
      s.rate_limit = false;
      break;
    case Ingredient::latency:
      s.delay = s.lag = s.second_lag = s.rate_limit = false;
      break;
    case Ingredient::regulator:
      s.regulator = false;
      break;
    case Ingredient::venting_lag:
      s.two_way = false;
      break;
    case Ingredient::characteristic:
      s.characteristic = s.envelopes = false;
      break;
    case Ingredient::resonance:
      s.resonance = false;
      break;
    case Ingredient::linear_modes:
      s.modes = 0;
      break;
    case Ingredient::envelopes:
      s.envelopes = false;
      break;
  }
  return s;
}

bool has(const BaseStructure& s, Ingredient ingredient) {
  if (ingredient == Ingredient::latency) return s.delay && s.lag;
  return without(s, ingredient) != s;
}

}  // namespace softgrip::sysid
