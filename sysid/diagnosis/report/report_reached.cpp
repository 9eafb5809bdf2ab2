#include "sysid/diagnosis/report/report_reached.h"

#include <string>
#include <vector>

#include "base/numbers.h"
#include "model/catalogue.h"
#include "sysid/diagnosis/causes/indistinguishable.h"
#include "sysid/diagnosis/evidence/clear.h"
#include "sysid/diagnosis/report/report_figures.h"
#include "sysid/diagnosis/report/report_gauge.h"
#include "sysid/diagnosis/report/report_tables.h"

namespace softgrip::sysid {
namespace {

std::string range(const Spread& s, int decimals) {
  return fixed(s.value, decimals) + " % (" + fixed(s.lower, decimals) + " to " + fixed(s.upper, decimals) +
         ")";
}

/// Returns the reason why the alternatives of a cause are listed with it.
std::string alternatives_text(const NamedCause& named, const model::Model& extended) {
  std::string alike, indistinguishable;
  for (const Cause& alternative : named.alternatives) {
    if (are_indistinguishable(named.cause, alternative, extended)) {
      indistinguishable = alternative.id;
    } else {
      alike += (alike.empty() ? "" : ", ") + std::string(alternative.id);
    }
  }
  std::string text;
  if (!alike.empty())
    text = "These logs cannot tell it from " + alike +
           ": each explains as much in its place, within one standard error. ";
  if (!indistinguishable.empty())
    text +=
        "No command can tell it from " + indistinguishable +
        ": both bend the readings over the displacement, the one before the load and the other behind it, "
        "and how well the form of each meets these logs says nothing about where the bend is.";
  return text;
}

/// Adds the frequency at which the search finds a cause in simulated data without one.
void add_null_calibration(Page& page, const NullCalibration& nulls) {
  page.paragraph(
      "Searched in the same way, " + std::to_string(nulls.campaigns) +
      " campaigns in which the recalibrated model and correlated noise are all there is gave a name in " +
      std::to_string(nulls.named) + " cases, with a gain of at most " + fixed(nulls.largest_gain_percent, 1) +
      " %; p = " + significant(nulls.p_value, 2) + " for the gain on the measured logs.");
}

void add_errors(Page& page, const Diagnosis& d) {
  page.section("How it was reached");
  page.paragraph(
      "The model was predicted as given, then recalibrated (the same structure, all parameters fitted), then "
      "extended cause by cause. Each was refitted without stretches of the logs and judged there, simulated "
      "from the logs' true starts; intervals by drawing whole stretches anew.");
  page.table(rmse_table(d));
  page.figure(runs_figure(d));
  if (is_extended(d) && d.extended_rmse_mm < d.recalibrated_rmse_mm)
    page.paragraph("The extended model's held-out error is smaller than the recalibrated one's by " +
                   range(d.gain, 1) + ".");
  if (!d.recalibrated_other_logs_rmse_mm || !d.extended_other_logs_rmse_mm || !is_extended(d)) return;
  const double before = *d.recalibrated_other_logs_rmse_mm;
  const double after = *d.extended_other_logs_rmse_mm;
  if (after >= before)
    page.paragraph(
        "The gain does not carry over to logs that were not fitted: with whole logs held out the error goes "
        "from " +
        significant(before, 3) + " to " + significant(after, 3) + " " +
        std::string(model::name_of(d.extended_model.output_unit)) + ".");
}

void add_evidence(Page& page, const Diagnosis& d) {
  if (!d.evidence) return;
  const ResidualEvidence& recalibrated = d.evidence->recalibrated;
  page.paragraph("After recalibration: " + dependence_sentence(recalibrated));
  Figure conditions = conditions_figure(d);
  if (!conditions.charts.empty()) page.figure(std::move(conditions));
  if (recalibrated.spectrum.why_not.empty() &&
      is_clear(recalibrated.spectrum.p_value, recalibrated.spectrum.share_percent))
    page.figure(spectrum_figure(d));
  std::vector<std::string> signs;
  for (const UnphysicalSign& sign : d.evidence->unphysical) signs.push_back(sign.sentence);
  if (signs.empty()) return;
  page.paragraph("New parameters absorbed part of the effect and bent the model in doing so:");
  page.list(signs);
}

void add_named(Page& page, const Diagnosis& d) {
  if (!d.partial.empty())
    page.paragraph("What explains part of the structure explains too little of it to be named the cause.");
  for (const auto* list : {&d.causes, &d.partial}) {
    for (const NamedCause& named : *list) {
      std::string meaning(model::catalogue()[named.block_type].info.meaning);
      if (!meaning.empty() && meaning.back() != '.') meaning += '.';
      page.paragraph(std::string(named.cause.title) + " (" + std::string(named.cause.id) + "): " + meaning +
                     " " + alternatives_text(named, d.extended.point.model));
    }
  }
  if (d.null_calibration) add_null_calibration(page, *d.null_calibration);
  if (d.causes.empty() && d.partial.empty() && d.rejected.empty())
    page.paragraph("The recalibrated model leaves no structure, so no cause was looked for.");
  if (d.unexplained_error.present)
    page.paragraph(
        "Share of the structure that stays unexplained: " + fixed(d.unexplained_percent, 1) + " %." +
        (d.evidence && is_extended(d) ? " After the extension: " + dependence_sentence(d.evidence->extended)
                                      : std::string()));
}

}  // namespace

void add_reached(Page& page, const DiagnosisReport& report) {
  const Diagnosis& d = report.result;
  add_errors(page, d);
  add_evidence(page, d);
  add_named(page, d);
  if (d.gauge) add_gauge_section(page, *d.gauge);
  if (d.warnings.empty()) return;
  page.section("What these data cannot tell");
  page.list(d.warnings);
}

}  // namespace softgrip::sysid
