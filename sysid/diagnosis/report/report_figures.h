#pragma once
// Draws the charts of a diagnosis. The line of the given model is always dotted, that of the recalibrated
// model dashed, and that of the extended model solid.

#include <cstddef>
#include <optional>
#include <vector>

#include "sysid/diagnosis/report/report.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// Returns the indices of the logs, sorted by the error reduction with the extended model (the recalibrated
/// model if there is no extended one), the largest first.
[[nodiscard]] std::vector<std::size_t> logs_by_gain(const Diagnosis& diagnosis);
/// Returns true if the pressure changes during at least 10 % of the time. A log that contains only pressure
/// steps shows no loops.
[[nodiscard]] bool has_loops(const Record& record);
/// Returns the first log in the order of logs_by_gain() that contains loops; see has_loops().
[[nodiscard]] std::optional<std::size_t> first_with_loops(const Diagnosis& diagnosis);

/// Returns the measured and predicted displacement over time, with the errors of two models (before and after
/// the extension or refit) on the same time axis.
[[nodiscard]] Figure error_figure(const Diagnosis& diagnosis, std::size_t record);
/// Returns the error of every available model on each run, which was left out of the fit.
[[nodiscard]] Figure runs_figure(const Diagnosis& diagnosis);
/// Returns displacement over pressure in two charts: the complete loops, and the part where the models differ
/// most.
[[nodiscard]] Figure loops_figure(const Diagnosis& diagnosis, std::size_t record);
/// Returns two charts: the reference with the tracked displacements, and the tracking errors.
[[nodiscard]] Figure closed_loop_figure(const ClosedLoopCurves& curves);
/// Returns the mean error with its interval over each condition on which the error depends significantly, two
/// charts per row. Without such a condition, the figure has no charts.
[[nodiscard]] Figure conditions_figure(const Diagnosis& diagnosis);
[[nodiscard]] Figure spectrum_figure(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
