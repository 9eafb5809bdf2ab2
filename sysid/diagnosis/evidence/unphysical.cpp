#include <algorithm>

#include "base/numbers.h"
#include "model/catalogue.h"
#include "sysid/diagnosis/evidence/evidence.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/identification/combinations.h"

namespace softgrip::sysid {
namespace {

/// A branch that would move the finger by so many times its span is a stiffness near zero.
constexpr double spans_of_a_branch = 3;
/// A time constant longer than so much of the longest log is not seen in it.
constexpr double share_of_log = 1.0;

void add_wrong_way(const model::Model& model, std::vector<UnphysicalSign>& signs) {
  for (const Combination& c : combinations_of(model)) {
    if (c.name != "beta_over_instantaneous_gain") continue;
    const double ratio = c.value(model);
    if (ratio <= 1 && ratio >= 0) continue;
    signs.push_back({"wrong_way_first",
                     "beta / (alpha + 1/k0) is " + significant(ratio, 3) +
                         ", above 1: recalibrated, the model moves the wrong way first. A latency that the "
                         "model lacks is the usual cause.",
                     ratio, 1});
  }
}

void add_branches(const model::Model& model, const std::vector<Record>& records,
                  std::vector<UnphysicalSign>& signs) {
  const auto position = model::position_of(model, "kelvin_voigt");
  if (!position) return;
  double span_mm = 0, largest_kpa = 0, longest_s = 0;
  for (const Record& record : records) {
    span_mm = std::max(span_mm, record.span_mm);
    largest_kpa = std::max(largest_kpa, record.largest_kpa);
    longest_s = std::max(longest_s, record.length_s());
  }
  const model::BlockSpec& block = model.blocks[*position];
  const std::vector<double> constants_s = branch_time_constants_s(model);
  for (std::size_t b = 0; b < constants_s.size(); ++b) {
    const std::string k = "k" + std::to_string(b + 1), c = "c" + std::to_string(b + 1);
    const double moved_mm = largest_kpa / block.values[1 + 2 * b];
    if (moved_mm > spans_of_a_branch * span_mm) {
      signs.push_back({"stiffness_near_zero",
                       k + " is near zero: settled, this branch alone would move " +
                           significant(moved_mm, 3) + " mm, and the finger moves " + significant(span_mm, 3) +
                           " mm.",
                       moved_mm, spans_of_a_branch * span_mm});
    }
    if (constants_s[b] > share_of_log * longest_s) {
      signs.push_back({"creep_beyond_data",
                       "the time constant " + c + "/" + k + " is " + significant(constants_s[b], 3) +
                           " s, longer than the longest log (" + significant(longest_s, 3) +
                           " s): the branch stands for something that drifts.",
                       constants_s[b], share_of_log * longest_s});
    }
  }
}

void add_bounds(const model::Model& model, std::vector<UnphysicalSign>& signs) {
  const std::vector<double> values = model::flat_values(model);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const model::ParameterSpec& spec = model::parameter_spec(model, i);
    const double value = values[i];
    if (spec.whole) continue;
    const bool low = value <= spec.lower + 1e-6 * spec.scale;
    if (!low && value < spec.upper * (1 - 1e-6)) continue;
    signs.push_back({"at_bound",
                     model::parameter_path(model, i) + " stands at the end of its range, " +
                         significant(value, 4) + " " + std::string(spec.unit) + ".",
                     value, low ? spec.lower : spec.upper});
  }
}

}  // namespace

std::vector<UnphysicalSign> unphysical_signs(const model::Model& model, const std::vector<Record>& records) {
  std::vector<UnphysicalSign> signs;
  add_wrong_way(model, signs);
  add_branches(model, records, signs);
  add_bounds(model, signs);
  return signs;
}

}  // namespace softgrip::sysid
