#pragma once
// The error budget as a picture: from the given model to the noise.

#include <string>
#include <vector>

#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// A part of what the recalibrated model leaves.
struct BudgetPart {
  std::string name;
  double mm2 = 0;
  Colour colour = Colour::faint;
  std::string interval;  ///< "0.01 to 0.02", or empty
};

/// They sum up to the recalibrated model's mean square of held-out readings: what each finding takes,
/// measured by leaving it out; what findings take only together; what is left; the noise. Where findings
/// overlap, so that what they take one by one is more than they take together, each stands for its share of
/// that.
[[nodiscard]] std::vector<BudgetPart> budget_parts(const Diagnosis& diagnosis);

[[nodiscard]] Figure budget_figure(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
