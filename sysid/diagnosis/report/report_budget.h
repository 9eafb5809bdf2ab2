#pragma once
// The error budget as a figure: from the error of the given model down to the noise.

#include <string>
#include <vector>

#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// A part of the error of the recalibrated model.
struct BudgetPart {
  std::string name;
  double mm2 = 0;
  Colour colour = Colour::faint;
  std::string interval;  ///< "0.01 to 0.02", or empty
};

/// Returns the parts of the recalibrated model's mean square of held-out readings; they add up to it. The
/// parts are: the reduction by each cause, measured by its removal; the reduction that several causes only
/// achieve together; the unexplained rest; the noise. If the reductions of single causes add up to more than
/// their common reduction, each is scaled down in proportion.
[[nodiscard]] std::vector<BudgetPart> budget_parts(const Diagnosis& diagnosis);

[[nodiscard]] Figure budget_figure(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
