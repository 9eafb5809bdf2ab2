// Computes residuals of any chain by automatic differentiation. Only this file instantiates Chain with
// derivatives. Idle threads process the records and the groups of derivatives in parallel.

#include <algorithm>
#include <cmath>

#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/slow_creep.h"
#include "model/chain_walk.h"
#include "model/named.h"
#include "sysid/fitting/gradient.h"
#include "sysid/fitting/residuals.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/fitting/trajectory_walk.h"
#include "sysid/logs/each_record.h"

namespace softgrip::sysid {
namespace {

/// Possible numbers of derivatives that one simulation computes together (a group). The parameters of one
/// cause fit into a small group. The parameters of a structure with two branches fit into a large group,
/// together with the first parameters of a cause.
constexpr std::size_t least_group = 4;
constexpr std::size_t small_group = 8;
constexpr std::size_t large_group = 12;

/// Returns the size of the next group if `left` derivatives remain to be computed. The sizes are chosen for
/// the smallest number of groups. If several choices need this number of groups, the smallest groups are
/// chosen.
std::size_t group_for(std::size_t left) {
  if (left <= least_group) return least_group;
  if (left <= small_group) return small_group;
  return left > large_group && left <= 2 * small_group ? small_group : large_group;
}

class ChainResiduals final : public Residuals {
 public:
  ChainResiduals(const std::vector<Record>& records, FitSpace space)
      : Residuals(records, std::move(space)), first_row_(first_rows_of(records)) {
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
    const std::vector<Group> groups = groups_of_derivatives();
    const std::size_t records = records_.size();
    for_each_walk(records_, groups.size() * records, [&](std::size_t task) {
      const Group& group = groups[task / records];
      const Part part{task % records, group.columns, task < records};
      if (group.size == least_group) {
        derivatives<least_group>(point, z, part, out, jacobian);
      } else if (group.size == small_group) {
        derivatives<small_group>(point, z, part, out, jacobian);
      } else {
        derivatives<large_group>(point, z, part, out, jacobian);
      }
    });
    for_each_record(records_, [&](std::size_t k) { start(point, z, k, out, jacobian); });
    return std::all_of(out.begin(), out.end(), [](double v) { return std::isfinite(v); }) &&
           std::all_of(jacobian.begin(), jacobian.end(), [](double v) { return std::isfinite(v); });
  }

 private:
  /// A group of derivatives that one simulation computes. `size` is the capacity of the group. `columns` are
  /// the columns of these derivatives in the Jacobian.
  struct Group {
    std::size_t size;
    std::vector<std::size_t> columns;
  };
  /// One simulation of a record, with one group of derivatives.
  struct Part {
    std::size_t record;
    const std::vector<std::size_t>& columns;
    bool values;  ///< true: the simulation also stores the residuals
  };

  /// Returns the groups of derivatives with respect to the model parameters and to the pressure peaks before
  /// the records. There is at least one group, because the simulation of the first group also computes the
  /// residuals.
  [[nodiscard]] std::vector<Group> groups_of_derivatives() const {
    std::vector<std::size_t> dynamic;
    for (std::size_t i = 0; i < space_.size(); ++i) {
      const auto kind = space_.free()[i].kind;
      if (kind == FreeParameter::Kind::model || kind == FreeParameter::Kind::peak_before)
        dynamic.push_back(i);
    }
    std::vector<Group> groups;
    auto next = dynamic.begin();
    do {
      const auto left = static_cast<std::size_t>(dynamic.end() - next);
      const std::size_t size = group_for(left);
      const auto last = next + static_cast<std::ptrdiff_t>(std::min(size, left));
      groups.push_back({size, {next, last}});
      next = last;
    } while (next != dynamic.end());
    return groups;
  }

  [[nodiscard]] bool values(const FitPoint& point, std::span<double> r) const {
    std::vector<char> finite(records_.size(), 1);
    for_each_record(records_, [&](std::size_t k) {
      const std::vector<double> prediction = predict(point.model, records_[k], point.starts[k]);
      std::size_t row = first_row_[k];
      for (std::size_t i = 0; i < prediction.size(); ++i) {
        if (!std::isfinite(records_[k].reading_mm[i])) continue;
        if (!std::isfinite(prediction[i])) finite[k] = 0;
        r[row++] = prediction[i] - records_[k].reading_mm[i];
      }
    });
    return std::all_of(finite.begin(), finite.end(), [](char one) { return one != 0; });
  }

  /// Simulates one record. Stores the output of the chain and its derivatives with respect to the parameters
  /// in the group.
  template <std::size_t group>
  void derivatives(const FitPoint& point, std::span<const double> z, const Part& part, std::span<double> r,
                   std::span<double> jacobian) const {
    using Number = Gradient<group>;
    const std::size_t k = part.record;
    const std::vector<double> flat = model::flat_values(point.model);
    std::vector<Number> values(flat.begin(), flat.end());
    Number peak(point.starts[k].peak_before_kpa);
    for (std::size_t c = 0; c < part.columns.size(); ++c) {
      const FreeParameter& p = space_.free()[part.columns[c]];
      const double slope = p.slope(z[part.columns[c]]);
      if (p.kind == FreeParameter::Kind::model) values[p.flat_index].v.set(c, slope);
      if (p.kind == FreeParameter::Kind::peak_before && p.record == k) peak.v.set(c, slope);
    }
    const Record& record = records_[k];
    std::size_t row = first_row_[k];
    walk<Number>(point.model, values, record, peak, point.starts[k], [&](std::size_t i, const Number& y) {
      if (!std::isfinite(record.reading_mm[i])) return;
      if (part.values) r[row] = y.a - record.reading_mm[i];
      double* const line = &jacobian[row * space_.size()];
      for (std::size_t c = 0; c < part.columns.size(); ++c) line[part.columns[c]] = y.v[c];
      ++row;
    });
  }

  /// Adds the offset and the unsettled creep of a record to the residuals, and computes their columns of the
  /// Jacobian.
  void start(const FitPoint& point, std::span<const double> z, std::size_t k, std::span<double> r,
             std::span<double> jacobian) const {
    const std::vector<CreepBranch> branches = creep_branches(point.model);
    const Record& record = records_[k];
    const StartState& state = point.starts[k];
    const std::vector<double> offset_line = offset_columns(z, k);
    const std::vector<std::size_t> unsettled = unsettled_branches(state);
    std::size_t row = first_row_[k];
    for (std::size_t i = 0; i < record.size(); ++i) {
      if (!std::isfinite(record.reading_mm[i])) continue;
      const double t = record.time_s[i] - record.time_s[0];
      r[row] += state.offset_mm;
      double* const line = &jacobian[row * space_.size()];
      for (const std::size_t b : unsettled) {
        const double time_constant_s = branches[b].time_constant_s;
        const double decay = std::exp(-t / time_constant_s);
        r[row] += state.unsettled_mm[b] * decay;
        creep_columns(point, z, b, state.unsettled_mm[b] * decay * t / time_constant_s, line);
        unsettled_column(z, k, b, decay, line);
      }
      for (const std::size_t c : offsets_) line[c] = offset_line[c];
      ++row;
    }
  }

  /// Returns those elements of a Jacobian row that are derivatives with respect to the offsets. These
  /// elements are equal in all rows of record k.
  [[nodiscard]] std::vector<double> offset_columns(std::span<const double> z, std::size_t k) const {
    std::vector<double> line(space_.size());
    for (const std::size_t c : offsets_) {
      const FreeParameter& p = space_.free()[c];
      line[c] = p.record == k ? p.slope(z[c]) : 0;
    }
    return line;
  }

  /// Returns the branches whose unsettled creep is not 0 or is a free parameter.
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

  /// Adds the derivatives of unsettled creep with respect to the parameters of its branch to a row. They are
  /// computed from the derivative with respect to ln tau, where tau is the time constant of the branch. It is
  /// c/k for a Kelvin-Voigt branch, and a parameter of the slow creep.
  void creep_columns(const FitPoint& point, std::span<const double> z, std::size_t branch, double by_ln_tau,
                     double* line) const {
    if (by_ln_tau == 0) return;
    const auto position = model::position_of<model::KelvinVoigt>(point.model);
    const auto slow = model::position_of<model::SlowCreep>(point.model);
    const std::size_t fast_branches = branch_time_constants_s(point.model).size();
    constexpr std::size_t time_constant = model::parameter_index<model::SlowCreep>("time_constant_s");
    for (std::size_t c = 0; c < space_.size(); ++c) {
      const FreeParameter& p = space_.free()[c];
      if (p.kind != FreeParameter::Kind::model) continue;
      const model::ParameterPlace place = model::place_of(point.model, p.flat_index);
      double sign = 0;
      if (branch < fast_branches && place.block == *position && place.value > 0 &&
          (place.value - 1) / 2 == branch)
        sign = (place.value - 1) % 2 == 0 ? -1 : 1;
      else if (branch == fast_branches && place.block == *slow && place.value == time_constant)
        sign = 1;
      else
        continue;
      line[c] += sign * by_ln_tau * p.slope(z[c]) / point.model.blocks[place.block].values[place.value];
    }
  }

  std::vector<std::size_t> offsets_;    ///< columns of the Jacobian that belong to the offsets of the records
  std::vector<std::size_t> first_row_;  ///< index of the first row of each record
};

}  // namespace

std::unique_ptr<Residuals> chain_residuals(const std::vector<Record>& records, FitSpace space) {
  return std::make_unique<ChainResiduals>(records, std::move(space));
}

}  // namespace softgrip::sysid
