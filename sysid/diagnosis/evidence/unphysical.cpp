#include <algorithm>

#include "base/numbers.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/catalogue.h"
#include "model/named.h"
#include "sysid/diagnosis/evidence/evidence.h"
#include "sysid/fitting/multistart.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/identification/combinations.h"

namespace softgrip::sysid {
namespace {

/// Largest plausible motion of a creep branch, as a multiple of the measured span. If the motion of a branch
/// is larger, the stiffness of the branch counts as near zero.
constexpr double spans_of_a_branch = 3;

void add_branches(const model::Model& model, const std::vector<Record>& records,
                  std::vector<UnphysicalSign>& signs) {
  const auto position = model::position_of<model::KelvinVoigt>(model);
  if (!position) return;
  const auto [largest_kpa, span_mm, longest_s] = campaign_size(records);
  const model::BlockSpec& block = model.blocks[*position];
  const std::string unit(model::name_of(model.output_unit));
  const std::vector<double> constants_s = branch_time_constants_s(model);
  for (std::size_t b = 0; b < constants_s.size(); ++b) {
    const std::string k = "k" + std::to_string(b + 1), c = "c" + std::to_string(b + 1);
    const double moved_mm = largest_kpa / block.values[1 + 2 * b];
    if (moved_mm > spans_of_a_branch * span_mm) {
      signs.push_back({"stiffness_near_zero",
                       k + " is near zero: in steady state, this branch alone would move the finger by " +
                           significant(moved_mm, 3) + " " + unit + ", but the finger moves only by " +
                           significant(span_mm, 3) + " " + unit + ".",
                       moved_mm, spans_of_a_branch * span_mm});
    }
    // A time constant above the length of the longest log cannot be determined from the data.
    if (constants_s[b] > longest_s) {
      signs.push_back({"creep_beyond_data",
                       "the time constant " + c + "/" + k + " is " + significant(constants_s[b], 3) +
                           " s, longer than the longest log (" + significant(longest_s, 3) +
                           " s), so the branch represents a drift.",
                       constants_s[b], longest_s});
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
                     model::parameter_path(model, i) + " is at the limit of its range, " +
                         significant(value, 4) + " " + std::string(spec.unit) + ".",
                     value, low ? spec.lower : spec.upper});
  }
}

}  // namespace

std::vector<UnphysicalSign> unphysical_signs(const model::Model& model, const std::vector<Record>& records) {
  std::vector<UnphysicalSign> signs;
  if (const double ratio = beta_over_gain(model); ratio > 1)
    signs.push_back({"inverse_response", wrong_way_sentence(ratio) + ".", ratio, 1, "wrong_way_first"});
  add_branches(model, records, signs);
  add_bounds(model, signs);
  return signs;
}

}  // namespace softgrip::sysid
