#pragma once
// Writes the sections of a diagnosis report, and creates their figures and tables. In all charts, the line of
// the given model is dotted, the line of the recalibrated model dashed, and the line of the extended model
// solid.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result/result.h"
#include "model/model.h"
#include "sysid/diagnosis/gauge/gauge_verdict.h"
#include "sysid/diagnosis/report/report.h"
#include "sysid/diagnosis/verdict/diagnosis.h"
#include "sysid/diagnosis/verdict/valve_findings.h"
#include "sysid/pages/chart.h"
#include "sysid/pages/figure.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {

/// One part of the mean square error of the refitted model.
struct BudgetPart {
  std::string name;
  double mm2 = 0;
  Colour colour = Colour::faint;
  std::string interval;  ///< confidence interval as text, for example "0.01 to 0.02"; empty: there is no
                         ///< interval
};

/// Divides the mean square error of the refitted model on held-out readings into parts. The first parts are
/// the error reductions by the single causes; each one is measured by the removal of this cause. The next
/// part is the reduction that only several causes together achieve. The last parts are the unexplained error
/// and the noise. If the reductions by the single causes exceed the reduction by all causes, they are scaled
/// down in proportion.
[[nodiscard]] std::vector<BudgetPart> budget_parts(const Diagnosis& diagnosis);

[[nodiscard]] Figure budget_figure(const Diagnosis& diagnosis);

/// Adds the appendix for readers who check the diagnosis: further logs, candidates, conditions, equations,
/// parameters and hashes.
void add_appendix(Page& page, const DiagnosisReport& report);

/// Returns the block diagram of `model` from the command to the reading. A block is marked if the model
/// `given` does not contain it.
[[nodiscard]] Figure chain_figure(const model::Model& model, const model::Model& given);

/// Returns one chart for each condition on which the error depends significantly, but at most four charts. A
/// chart shows the mean error and its 95 % interval over the condition. Two charts are placed side by side.
/// If the error depends on no condition, the figure contains no charts.
[[nodiscard]] Figure conditions_figure(const Diagnosis& diagnosis);

/// Returns the indices of the logs, sorted by the error reduction, the largest first. The reduction is the
/// difference between the mean square errors of the refitted and the extended model or, without an extension,
/// of the given and the refitted model.
[[nodiscard]] std::vector<std::size_t> logs_by_gain(const Diagnosis& diagnosis);
/// Returns true if the pressure changes during at least 10 % of the duration of the log. A log with shorter
/// changes consists of pressure steps, and a plot of the displacement over the pressure shows no loops.
[[nodiscard]] bool has_loops(const Record& record);
/// Returns the index of the first log in logs_by_gain() for which has_loops() is true. Returns nullopt if
/// there is no such log.
[[nodiscard]] std::optional<std::size_t> first_with_loops(const Diagnosis& diagnosis);

/// Returns charts with a common time axis. The first chart shows the measured and the predicted displacement,
/// and the second one the errors of the given and the refitted model. If the model was extended, a third
/// chart shows the errors of the extended model.
[[nodiscard]] Figure error_figure(const Diagnosis& diagnosis, std::size_t record);
/// Returns a chart of the error of each available model on each run, or on each half of a single run. For
/// each error, the refitted and the extended model were fitted to the other runs or to the other half.
[[nodiscard]] Figure runs_figure(const Diagnosis& diagnosis);
/// Returns two charts of the displacement over the pressure. The first chart shows the complete loops. The
/// second chart shows the section in which the models differ most.
[[nodiscard]] Figure loops_figure(const Diagnosis& diagnosis, std::size_t record);
/// Returns two charts. The first chart shows the reference and the displacements that the schemes reach. The
/// second chart shows the tracking errors.
[[nodiscard]] Figure closed_loop_figure(const ClosedLoopCurves& curves);
[[nodiscard]] Figure spectrum_figure(const Diagnosis& diagnosis);

/// Returns the forest plot of the error reductions by the named causes and their alternatives. The diagnosis
/// must contain at least one named cause or partial explanation.
[[nodiscard]] Figure forest_figure(const Diagnosis& diagnosis);

/// Returns a chart of the gauge readings and of the predictions of all hypotheses over the gauge position.
/// The chart shows deviations from the straight line that fits the readings best.
[[nodiscard]] Chart gauge_chart(const GaugeEvidence& gauge);

/// Returns the fields of a hypothesis about the static curve of the sensor. The hypothesis was tested with
/// the gauge readings.
[[nodiscard]] result::Fields hypothesis_fields(const GaugeFit& fit, model::OutputUnit unit);
/// Adds the section about the gauge check to the page.
void add_gauge_section(Page& page, const GaugeEvidence& gauge);

/// Adds the section about the method and the evidence of the diagnosis: errors of the models, conditions on
/// which these errors depend, reasons for the named causes, and limitations of the data.
void add_reached(Page& page, const DiagnosisReport& report);

/// Returns a percentage with its interval as text, for example "41.2 (33.6 to 46.6)".
[[nodiscard]] std::string percent_range(const Spread& share, int decimals = 1);
/// Returns a percentage with its interval. In JSON, the value is an object with the keys value and ci95. As
/// text, the value is percent_range().
[[nodiscard]] result::Value spread_value(const Spread& spread, int decimals = 1);
/// Returns a table of the errors of the given, the refitted and the extended model. The errors are evaluated
/// on all readings, on held-out blocks and on held-out logs.
[[nodiscard]] Table rmse_table(const Diagnosis& diagnosis);
/// Returns a table with one row per condition. A row states, for each available model, the share of the
/// residual variance above the noise that the condition explains. For the refitted and the extended model, it
/// also states the adjusted p-value.
[[nodiscard]] Table condition_table(const Evidence& evidence, bool extended);
/// Returns the fields of each candidate that was tested to replace the cause `chosen`. If `chosen` is
/// nullptr, returns the fields of the candidates that were tested as an additional cause.
[[nodiscard]] std::vector<result::Fields> candidate_rows(const Diagnosis& diagnosis,
                                                         const NamedCause* chosen);
/// Returns one table of candidates per named cause, and a last table. The candidates in the table of a cause
/// were tested as its replacement. The candidates in the last table were tested as an additional cause.
[[nodiscard]] std::vector<Table> candidate_tables(const Diagnosis& diagnosis);
/// Returns the fields of the errors of the models on one run.
[[nodiscard]] result::Fields run_fields(const Diagnosis& diagnosis, const RunError& run);
/// Returns a table of the errors of the models on each run. For the error on a run, the refitted and the
/// extended model were fitted to the other runs.
[[nodiscard]] Table run_table(const Diagnosis& diagnosis);
/// Returns the causes that the first part of the report shows. These are the named causes, and the partial
/// explanations whose error reduction is significantly greater than zero.
[[nodiscard]] std::vector<const NamedCause*> shown_causes(const Diagnosis& diagnosis);
/// Returns the fields of a parameter: its value, its interval and the title of its cause.
[[nodiscard]] result::Fields parameter_fields(std::string_view cause, const CauseParameter& parameter);
/// Returns a table of the parameters of shown_causes() with their intervals. If a cause has more than `most`
/// parameters, the table lists only the first parameters with an interval.
[[nodiscard]] Table cause_parameter_table(const Diagnosis& diagnosis, std::size_t most);
/// Returns a table of the parameters of the given, the refitted and the extended model.
[[nodiscard]] Table moved_table(const Diagnosis& diagnosis, const model::Model& given);

/// Adds the section about the valve to the page. This section requires a measured pressure.
void add_valve_section(Page& page, const ValveFindings& in_valve);

}  // namespace softgrip::sysid
