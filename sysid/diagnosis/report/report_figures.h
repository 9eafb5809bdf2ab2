#pragma once
// The charts of a diagnosis. In all of them the given model is dotted, the recalibrated one dashed, the
// extended one solid.

#include <cstddef>
#include <optional>
#include <vector>

#include "sysid/diagnosis/report/report.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// The logs' indices: those first of which extending (or recalibrating, where nothing was added) takes most.
[[nodiscard]] std::vector<std::size_t> logs_by_gain(const Diagnosis& diagnosis);
/// Returns true if the pressure moves for 10 % of the time: a pressure that only steps shows no loops.
[[nodiscard]] bool has_loops(const Record& record);
/// The first of logs_by_gain that has loops.
[[nodiscard]] std::optional<std::size_t> first_with_loops(const Diagnosis& diagnosis);

/// Measured and the models over time, and on the same axis the errors before and after.
[[nodiscard]] Figure error_figure(const Diagnosis& diagnosis, std::size_t record);
/// The error of every run that was left out of the fit, under the models that there are.
[[nodiscard]] Figure runs_figure(const Diagnosis& diagnosis);
/// Displacement over pressure, as a whole and where the models differ most.
[[nodiscard]] Figure loops_figure(const Diagnosis& diagnosis, std::size_t record);
/// The reference and what follows it, and the tracking errors.
[[nodiscard]] Figure closed_loop_figure(const ClosedLoopCurves& curves);
/// Conditional means with their intervals of conditions on which the error clearly depends, two beside each
/// other. No charts where there are none.
[[nodiscard]] Figure conditions_figure(const Diagnosis& diagnosis);
[[nodiscard]] Figure spectrum_figure(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
