#pragma once
// Writes the sections of a diagnosis report, and creates their figures and tables. In all charts, the line of
// the given model is dotted, the line of the recalibrated model dashed, and the line of the extended model
// solid.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/diagnosis/gauge/gauge_verdict.h"
#include "sysid/diagnosis/report/report.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/diagnosis/verdict/valve_findings.h"
#include "sysid/pages/chart.h"
#include "sysid/pages/figure.h"
#include "sysid/pages/page.h"

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

/// Adds the appendix for readers who check the diagnosis: further logs, candidates, conditions, equations,
/// parameters and hashes.
void add_appendix(Page& page, const DiagnosisReport& report);

/// Returns the block diagram of `model` from command to reading. Blocks that the model `given` does not
/// contain are marked.
[[nodiscard]] Figure chain_figure(const model::Model& model, const model::Model& given);

/// Returns one chart for each condition on which the error depends significantly. Each chart shows the mean
/// error and its 95 % interval as a function of the condition. Two charts are side by side. If there is no
/// such condition, the figure has no charts.
[[nodiscard]] Figure conditions_figure(const Diagnosis& diagnosis);

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

/// Returns the forest plot of the error reductions by the named causes and their alternatives. The diagnosis
/// must contain at least one named cause or partial explanation.
[[nodiscard]] Figure forest_figure(const Diagnosis& diagnosis);

/// Returns a chart of the readings and the predictions of the hypotheses over the gauge position. The
/// straight line that fits the readings best is subtracted from the readings and from the predictions.
[[nodiscard]] Chart gauge_chart(const GaugeEvidence& gauge);

/// Adds the section about the gauge check to the page.
void add_gauge_section(Page& page, const GaugeEvidence& gauge);

/// Adds the section about the method and the evidence of the diagnosis: errors of the models, conditions on
/// which these errors depend, reasons for the named causes, and limitations of the data.
void add_reached(Page& page, const DiagnosisReport& report);

/// Returns a percentage with its interval as text: "41.2 (33.6 to 46.6)".
[[nodiscard]] std::string percent_range(const Spread& share);
/// Returns the errors of the given, the recalibrated and the extended model on all readings, on held-out
/// blocks and on held-out logs.
[[nodiscard]] Table rmse_table(const Diagnosis& diagnosis);
/// Returns a table with one row per condition. For each available model, it states the share of the residual
/// variance that the condition explains, and the p-value.
[[nodiscard]] Table condition_table(const Evidence& evidence, bool extended);
/// Returns one table per cause with the candidates that were tested as its replacement. The last table
/// contains the candidates that were tested as an additional cause.
[[nodiscard]] std::vector<Table> candidate_tables(const Diagnosis& diagnosis);
/// Returns the errors of the models on each run. The models were fitted to the other runs.
[[nodiscard]] Table run_table(const Diagnosis& diagnosis);
/// Returns the causes that the first part of the report shows. These are the named causes, and the partial
/// explanations whose error reduction is significantly above zero.
[[nodiscard]] std::vector<const NamedCause*> shown_causes(const Diagnosis& diagnosis);
/// Returns the parameters of the shown causes with their intervals. If a cause has more than `most`
/// parameters, the table lists only the first ones that have an interval.
[[nodiscard]] Table cause_parameter_table(const Diagnosis& diagnosis, std::size_t most);
/// Returns the parameters of the given, the recalibrated and the extended model.
[[nodiscard]] Table moved_table(const Diagnosis& diagnosis, const model::Model& given);

/// Adds the section about the valve to the page. This section requires a measured pressure.
void add_valve_section(Page& page, const ValveFindings& in_valve);

}  // namespace softgrip::sysid
