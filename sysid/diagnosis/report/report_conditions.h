#pragma once
// Draws the model error as a function of each condition on which it depends.

#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// Returns one chart for each condition on which the error depends significantly. Each chart shows the mean
/// error and its 95 % interval as a function of the condition. Two charts are side by side. If there is no
/// such condition, the figure has no charts.
[[nodiscard]] Figure conditions_figure(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
