#pragma once
// Draws the charts of a diagnosis. In all charts, the line of the given model is dotted, the line of the
// recalibrated model dashed, and the line of the extended model solid.

#include <cstddef>
#include <optional>
#include <vector>

#include "sysid/diagnosis/report/report.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/pages/figure.h"

namespace softgrip::sysid {

/// Returns the indices of the logs in the order of decreasing error reduction. This is the reduction by the
/// extended model or, if there is no extended model, by the recalibrated model.
[[nodiscard]] std::vector<std::size_t> logs_by_gain(const Diagnosis& diagnosis);
/// Returns true if the pressure changes during at least 10 % of the time. Otherwise the log contains only
/// pressure steps, and a plot over the pressure shows no loops.
[[nodiscard]] bool has_loops(const Record& record);
/// Returns the index of the log that comes first in logs_by_gain() and has loops (has_loops()). Returns
/// nullopt if no log has loops.
[[nodiscard]] std::optional<std::size_t> first_with_loops(const Diagnosis& diagnosis);

/// Returns two charts with the same time axis. The first chart shows the measured and the predicted
/// displacement. The second one shows the errors of two models, before and after the extension or refit.
[[nodiscard]] Figure error_figure(const Diagnosis& diagnosis, std::size_t record);
/// Returns the error of each available model on each run. The models were fitted to the other runs.
[[nodiscard]] Figure runs_figure(const Diagnosis& diagnosis);
/// Returns two charts of the displacement over the pressure: the complete loops, and the region where the
/// models differ most.
[[nodiscard]] Figure loops_figure(const Diagnosis& diagnosis, std::size_t record);
/// Returns two charts: the reference with the tracked displacements, and the tracking errors.
[[nodiscard]] Figure closed_loop_figure(const ClosedLoopCurves& curves);
[[nodiscard]] Figure spectrum_figure(const Diagnosis& diagnosis);

}  // namespace softgrip::sysid
