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

/// Returns the indices of the logs in order of the error reduction by the extended (or else the recalibrated)
/// model, the largest first.
[[nodiscard]] std::vector<std::size_t> logs_by_gain(const Diagnosis& diagnosis);
/// Returns true if the pressure changes for 10 % of the time. A pressure with steps only shows no loops.
[[nodiscard]] bool has_loops(const Record& record);
/// Returns the first log of logs_by_gain() with loops.
[[nodiscard]] std::optional<std::size_t> first_with_loops(const Diagnosis& diagnosis);

/// Returns the measured and predicted displacement over time, with the errors before and after on the same
/// time axis.
[[nodiscard]] Figure error_figure(const Diagnosis& diagnosis, std::size_t record);
/// Returns the error of every run that was left out of the fit, under each available model.
[[nodiscard]] Figure runs_figure(const Diagnosis& diagnosis);
/// Returns displacement over pressure: the complete loops, and the part where the models differ most.
[[nodiscard]] Figure loops_figure(const Diagnosis& diagnosis, std::size_t record);
/// Returns the reference with the tracked displacements, and the tracking errors.
[[nodiscard]] Figure closed_loop_figure(const ClosedLoopCurves& curves);
/// Returns conditional means with intervals for the conditions on which the error significantly depends, two
/// per row. The figure has no charts if there are no such conditions.
[[nodiscard]] Figure conditions_figure(const Diagnosis& diagnosis);
[[nodiscard]] Figure spectrum_figure(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
