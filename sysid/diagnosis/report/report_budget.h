#pragma once
// Draws the error budget: the error of the given model is divided into its parts down to the noise.

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
  std::string interval;  ///< interval such as "0.01 to 0.02", or empty
};

/// Returns parts whose sum is the mean square of the recalibrated model on held-out readings. The parts are
/// the reduction by each cause, measured by its removal; the further reduction that only several causes
/// together achieve; the unexplained error; and the noise. If the reductions by single causes add up to more
/// than the reduction by all causes together, each is scaled down in proportion.
[[nodiscard]] std::vector<BudgetPart> budget_parts(const Diagnosis& diagnosis);

[[nodiscard]] Figure budget_figure(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
