#include "sysid/structure/structure_fit.h"

#include <algorithm>

#include "model/blocks/asymmetric_valve_lag.h"
#include "model/blocks/bouc_wen.h"
#include "model/blocks/chamber_lag.h"
#include "model/blocks/characteristic.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/linear_modes.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/blocks/pressure_dependent_creep.h"
#include "model/blocks/pressure_regulator.h"
#include "model/blocks/rate_limit.h"
#include "model/blocks/transport_delay.h"
#include "model/blocks/valve_deadband.h"
#include "model/blocks/valve_lag.h"
#include "model/named.h"
#include "sysid/structure/published_element.h"
#include "sysid/structure/structure_columns.h"

namespace softgrip::sysid {
namespace {

/// Stiffness k0 of a spring that is practically rigid. The instantaneous gain of the model is then alpha
/// (Bouc-Wen) or the gain of the elastic play operator.
constexpr double rigid_kpa_per_mm = 1e9;

class Builder {
 public:
  Builder(const FittedStructure& fit, const ColumnLayout& layout) : fit_(fit), layout_(layout) {}

  model::Model model(Drive drive) {
    const NonlinearNumbers& n = fit_.numbers;
    if (fit_.structure.delay && n.delay_s > 0) add<model::TransportDelay>({n.delay_s});
    if (fit_.structure.lag) add_lag(drive);
    if (!fit_.structure.linear) add_hysteresis();
    add_creep();
    add_hinged_creep();
    add_modes();
    if (fit_.structure.characteristic && n.curvature != 0)
      add<model::Characteristic>({n.curvature, fit_.grid.span_mm});
    return std::move(model_);
  }

 private:
  template <template <class> class Block>
  void add(std::vector<double> values) {
    model_ = model::with_block(std::move(model_), {model::block_type<Block>(), std::move(values)});
  }
  void add_lag(Drive drive) {
    const NonlinearNumbers& n = fit_.numbers;
    if (drive == Drive::measured) {
      add<model::ChamberLag>({n.filling_s, n.venting_s});
    } else if (fit_.structure.regulator) {
      if (n.pilot_band_kpa > 0) add<model::ValveDeadband>({n.pilot_band_kpa});
      add<model::PressureRegulator>({n.filling_s, n.venting_s, n.overlap_kpa, n.integral_s, n.full_open_kpa});
    } else {
      if (fit_.structure.second_lag) add<model::ValveLag>({n.second_s});
      add<model::AsymmetricValveLag>({n.filling_s, n.venting_s});
      if (fit_.structure.rate_limit) add<model::RateLimit>({n.filling_s_per_kpa, n.venting_s_per_kpa});
    }
  }

  [[nodiscard]] double weight(Eigen::Index column) const { return fit_.weights(column); }

  void add_hysteresis() {
    const double elastic = weight(ColumnLayout::elastic());
    if (fit_.structure.hysteresis == HysteresisForm::bouc_wen) {
      const double beta = fit_.structure.hysteretic ? weight(ColumnLayout::hysteresis(0)) : 0;
      const double eta = fit_.numbers.growing_per_kpa * fit_.numbers.narrowing;
      add<model::BoucWen>(
          {elastic + steepest_state(fit_.numbers) * beta, beta, fit_.numbers.growing_per_kpa - eta, eta, 1});
      return;
    }
    const bool bent = fit_.structure.envelopes;
    std::vector<double> parts{fit_.numbers.trained_kpa,
                              bent ? fit_.numbers.envelope_bend : 0,
                              bent ? fit_.numbers.envelope_skew : 0,
                              bent ? fit_.grid.largest_kpa : 0,
                              0,
                              elastic};
    for (std::size_t i = 0; i < layout_.hysteretic(); ++i) {
      if (const double w = weight(ColumnLayout::hysteresis(i)); w > 0)
        parts.insert(parts.end(), {fit_.grid.thresholds_kpa[i], w});
    }
    add<model::PrandtlIshlinskii>(std::move(parts));
  }

  void add_creep() {
    std::vector<double> values{rigid_kpa_per_mm};
    for (std::size_t b = 0; b < layout_.branches(); ++b) {
      const double w = weight(layout_.creep(b));
      if (w <= 0) continue;
      const double k = 1 / std::max(w, least_compliance_mm_per_kpa(fit_.grid.ladder_s[b]));
      values.insert(values.end(), {k, k * fit_.grid.ladder_s[b]});
    }
    if (values.size() > 1) add<model::KelvinVoigt>(std::move(values));
  }

  void add_hinged_creep() {
    std::vector<double> parts;
    for (std::size_t h = 0; h < layout_.hinges(); ++h) {
      for (std::size_t b = 0; b < layout_.hinge_branches(); ++b) {
        const double w = weight(layout_.hinged(h, b));
        if (w > 0) parts.insert(parts.end(), {fit_.grid.hinges_kpa[h], w, fit_.grid.hinge_ladder_s[b]});
      }
    }
    if (!parts.empty()) add<model::PressureDependentCreep>(std::move(parts));
  }

  void add_modes() {
    std::vector<double> values{fit_.structure.linear ? weight(ColumnLayout::elastic()) : 0};
    for (std::size_t k = 0; k < layout_.modes(); ++k) {
      const ModeNumbers& mode = fit_.numbers.modes[k];
      values.insert(values.end(), {mode.period_s, mode.damping_ratio, weight(layout_.mode(k)),
                                   weight(layout_.mode(k) + 1)});
    }
    if (fit_.structure.linear || values.size() > 1) add<model::LinearModes>(std::move(values));
  }

  const FittedStructure& fit_;
  const ColumnLayout& layout_;
  model::Model model_;
};

/// Duration of a jump of the pressure at the first sample [s].
constexpr double jump_s = 1e-6;

/// Sets a start at rest at `from_kpa` with a jump to `first_kpa`.
void jump(StartState& start, double from_kpa, double first_kpa) {
  if (from_kpa == first_kpa) return;
  (from_kpa < first_kpa ? start.valley_before_kpa : start.peak_before_kpa) = from_kpa;
  start.arrival_kpa_per_s = (first_kpa - from_kpa) / jump_s;
}

}  // namespace

bool has_raised_creep(const FittedStructure& fit, const std::vector<Record>& records) {
  const ColumnLayout layout(fit.structure, fit.grid, records);
  for (std::size_t b = 0; b < layout.branches(); ++b) {
    const double w = fit.weights(layout.creep(b));
    if (w > 0 && w < least_compliance_mm_per_kpa(fit.grid.ladder_s[b])) return true;
  }
  return false;
}

FitPoint point_of(const FittedStructure& fit, const std::vector<Record>& records, Drive drive) {
  const ColumnLayout layout(fit.structure, fit.grid, records);
  FitPoint point{Builder(fit, layout).model(drive), {}};
  if (!records.empty()) point.model.output_unit = records.front().output_unit;
  for (std::size_t r = 0; r < records.size(); ++r) {
    StartState start;
    if (layout.offset(r) >= 0) start.offset_mm = fit.weights(layout.offset(r));
    if (fit.structure.linear && !fit.numbers.jumped_from_kpa.empty())
      jump(start, fit.numbers.jumped_from_kpa[r], records[r].drive_kpa.front());
    else if (records[r].start_unknown)
      start.peak_before_kpa = fit.numbers.peak_before_kpa[r];
    for (std::size_t b = 0; layout.unsettled(r) >= 0 && b < layout.branches(); ++b)
      start.unsettled_mm.push_back(fit.weights(layout.unsettled(r) + static_cast<Eigen::Index>(b)));
    point.starts.push_back(std::move(start));
  }
  return point;
}

}  // namespace softgrip::sysid
