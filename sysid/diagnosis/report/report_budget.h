#pragma once
// Draws the error budget: the parts of the mean square error of the given model, including the noise.

#include <string>
#include <vector>

#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// One part of the mean square error of the recalibrated model.
struct BudgetPart {
  std::string name;
  double mm2 = 0;
  Colour colour = Colour::faint;
  std::string interval;  ///< confidence interval as text, such as "0.01 to 0.02", or empty
};

/// Returns parts whose sum is the mean square error of the recalibrated model on held-out readings. There are
/// four kinds of parts: the error reduction by each cause, measured by the removal of this cause; the
/// additional reduction that only several causes together achieve; the unexplained error; and the noise. If
/// the reductions by single causes add up to more than the reduction by all causes together, they are scaled
/// down in proportion.
[[nodiscard]] std::vector<BudgetPart> budget_parts(const Diagnosis& diagnosis);

[[nodiscard]] Figure budget_figure(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
