// Residuals of any chain by automatic differentiation. The only file that instantiates Chain with
// derivatives.

#include <algorithm>
#include <array>
#include <cmath>

#include "model/blocks/kelvin_voigt.h"
#include "model/named.h"
#include "sysid/fitting/gradient.h"
#include "sysid/fitting/residuals.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/fitting/trajectory_walk.h"

namespace softgrip::sysid {
namespace {

/// Derivatives are carried along in groups of one of these sizes: a cause's own parameters need a run of few,
/// a base with two branches and a cause's first parameters one run of many.
constexpr std::size_t least_group = 4;
constexpr std::size_t small_group = 8;
constexpr std::size_t large_group = 12;

/// The size of the next group when so many derivatives are left: as few runs as possible, then as narrow.
std::size_t group_for(std::size_t left) {
  if (left <= least_group) return least_group;
  if (left <= small_group) return small_group;
  return left > large_group && left <= 2 * small_group ? small_group : large_group;
}

class ChainResiduals final : public Residuals {
 public:
  ChainResiduals(const std::vector<Record>& records, FitSpace space) : Residuals(records, std::move(space)) {
    for (std::size_t c = 0; c < space_.size(); ++c) {
      if (space_.free()[c].kind == FreeParameter::Kind::offset) offsets_.push_back(c);
    }
  }

  bool evaluate(std::span<const double> z, std::span<double> r, std::span<double> jacobian) const override {
    const FitPoint point = space_.point(z);
    if (!model::validate(point.model).empty()) return false;
    if (jacobian.empty()) return values(point, r);
    std::vector<double> own(r.empty() ? count_ : 0);
    const std::span<double> out = r.empty() ? std::span<double>(own) : r;
    // Groups of model parameters and peaks; at least one, for the values.
    std::vector<std::size_t> dynamic;
    for (std::size_t i = 0; i < space_.size(); ++i) {
      const auto kind = space_.free()[i].kind;
      if (kind == FreeParameter::Kind::model || kind == FreeParameter::Kind::peak_before)
        dynamic.push_back(i);
    }
    std::size_t first = 0;
    do {
      const std::size_t group = group_for(dynamic.size() - first);
      const std::size_t last = std::min(first + group, dynamic.size());
      const std::span<const std::size_t> columns = std::span(dynamic).subspan(first, last - first);
      if (group == least_group) {
        derivatives<least_group>(point, z, columns, out, jacobian);
      } else if (group == small_group) {
        derivatives<small_group>(point, z, columns, out, jacobian);
      } else {
        derivatives<large_group>(point, z, columns, out, jacobian);
      }
      first = last;
    } while (first < dynamic.size());
    starts(point, z, out, jacobian);
    return std::all_of(out.begin(), out.end(), [](double v) { return std::isfinite(v); }) &&
           std::all_of(jacobian.begin(), jacobian.end(), [](double v) { return std::isfinite(v); });
  }

 private:
  [[nodiscard]] bool values(const FitPoint& point, std::span<double> r) const {
    std::size_t row = 0;
    for (std::size_t k = 0; k < records_.size(); ++k) {
      const std::vector<double> prediction = predict(point.model, records_[k], point.starts[k]);
      for (std::size_t i = 0; i < prediction.size(); ++i) {
        if (!std::isfinite(records_[k].reading_mm[i])) continue;
        if (!std::isfinite(prediction[i])) return false;
        r[row++] = prediction[i] - records_[k].reading_mm[i];
      }
    }
    return true;
  }

  /// Values of the chain and derivatives by the parameters in `columns`.
  template <std::size_t group>
  void derivatives(const FitPoint& point, std::span<const double> z, std::span<const std::size_t> columns,
                   std::span<double> r, std::span<double> jacobian) const {
    using Number = Gradient<group>;
    const std::vector<double> flat = model::flat_values(point.model);
    std::size_t row = 0;
    for (std::size_t k = 0; k < records_.size(); ++k) {
      std::vector<Number> values(flat.begin(), flat.end());
      Number peak(point.starts[k].peak_before_kpa);
      for (std::size_t c = 0; c < columns.size(); ++c) {
        const FreeParameter& p = space_.free()[columns[c]];
        const double slope = p.slope(z[columns[c]]);
        if (p.kind == FreeParameter::Kind::model) values[p.flat_index].v.set(c, slope);
        if (p.kind == FreeParameter::Kind::peak_before && p.record == k) peak.v.set(c, slope);
      }
      const Record& record = records_[k];
      walk<Number>(point.model, values, record, peak, [&](std::size_t i, const Number& y) {
        if (!std::isfinite(record.reading_mm[i])) return;
        r[row] = y.a - record.reading_mm[i];
        double* const line = &jacobian[row * space_.size()];
        for (std::size_t c = 0; c < columns.size(); ++c) line[columns[c]] = y.v[c];
        ++row;
      });
    }
  }

  /// Adds offset and unsettled creep, and fills their columns.
  void starts(const FitPoint& point, std::span<const double> z, std::span<double> r,
              std::span<double> jacobian) const {
    const std::vector<double> time_constants = branch_time_constants_s(point.model);
    std::size_t row = 0;
    for (std::size_t k = 0; k < records_.size(); ++k) {
      const Record& record = records_[k];
      const StartState& state = point.starts[k];
      const std::vector<double> offset_line = offset_columns(z, k);
      const std::vector<std::size_t> unsettled = unsettled_branches(state);
      for (std::size_t i = 0; i < record.size(); ++i) {
        if (!std::isfinite(record.reading_mm[i])) continue;
        const double t = record.time_s[i] - record.time_s[0];
        r[row] += state.offset_mm;
        double* const line = &jacobian[row * space_.size()];
        for (const std::size_t b : unsettled) {
          const double decay = std::exp(-t / time_constants[b]);
          r[row] += state.unsettled_mm[b] * decay;
          creep_columns(point, z, b, state.unsettled_mm[b] * decay * t / time_constants[b], line);
          unsettled_column(z, k, b, decay, line);
        }
        for (const std::size_t c : offsets_) line[c] = offset_line[c];
        ++row;
      }
    }
  }

  /// The columns of the offsets: the same in every row of record k.
  [[nodiscard]] std::vector<double> offset_columns(std::span<const double> z, std::size_t k) const {
    std::vector<double> line(space_.size());
    for (const std::size_t c : offsets_) {
      const FreeParameter& p = space_.free()[c];
      line[c] = p.record == k ? p.slope(z[c]) : 0;
    }
    return line;
  }

  /// Branches whose unsettled creep is there or may be fitted.
  [[nodiscard]] std::vector<std::size_t> unsettled_branches(const StartState& state) const {
    std::vector<std::size_t> branches;
    for (std::size_t b = 0; b < state.unsettled_mm.size(); ++b) {
      const auto fitted = [&](const FreeParameter& p) {
        return p.kind == FreeParameter::Kind::unsettled && p.branch == b;
      };
      if (state.unsettled_mm[b] != 0 || std::any_of(space_.free().begin(), space_.free().end(), fitted))
        branches.push_back(b);
    }
    return branches;
  }

  void unsettled_column(std::span<const double> z, std::size_t record, std::size_t branch, double decay,
                        double* line) const {
    for (std::size_t c = 0; c < space_.size(); ++c) {
      const FreeParameter& p = space_.free()[c];
      if (p.kind == FreeParameter::Kind::unsettled && p.branch == branch) {
        line[c] = p.record == record ? p.slope(z[c]) * decay : 0;
      }
    }
  }

  /// The unsettled creep depends on the branch's time constant c/k: d/d ln tau is given.
  void creep_columns(const FitPoint& point, std::span<const double> z, std::size_t branch, double by_ln_tau,
                     double* line) const {
    if (by_ln_tau == 0) return;
    const auto position = model::position_of<model::KelvinVoigt>(point.model);
    for (std::size_t c = 0; c < space_.size(); ++c) {
      const FreeParameter& p = space_.free()[c];
      if (p.kind != FreeParameter::Kind::model) continue;
      const model::ParameterPlace place = model::place_of(point.model, p.flat_index);
      if (!position || place.block != *position || place.value == 0 || (place.value - 1) / 2 != branch)
        continue;
      const double sign = (place.value - 1) % 2 == 0 ? -1 : 1;
      line[c] += sign * by_ln_tau * p.slope(z[c]) / point.model.blocks[place.block].values[place.value];
    }
  }

  std::vector<std::size_t> offsets_;  ///< columns of the records' offsets
};

}  // namespace

std::unique_ptr<Residuals> chain_residuals(const std::vector<Record>& records, FitSpace space) {
  return std::make_unique<ChainResiduals>(records, std::move(space));
}

}  // namespace softgrip::sysid
