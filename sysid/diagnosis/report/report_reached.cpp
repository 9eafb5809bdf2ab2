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

/// Returns the sentence that explains why alternatives are listed for a cause.
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
    text = "These logs cannot separate it from " + alike +
           ": each of them explains the error equally well within one standard error. ";
  if (!indistinguishable.empty())
    text += "No command can separate it from " + indistinguishable +
            ": both make the readings nonlinear in the displacement, one before the load and the other after "
            "it. The fit of their catalogue forms does not show where the nonlinearity is.";
  return text;
}

/// Adds a paragraph that states how often the search finds a cause in simulated data that contain no cause.
void add_null_calibration(Page& page, const NullCalibration& nulls) {
  page.paragraph("The same search was applied to " + std::to_string(nulls.campaigns) +
                 " simulated campaigns that contain only the recalibrated model and correlated noise. It "
                 "named a cause in " +
                 std::to_string(nulls.named) + " of them, with an error reduction of at most " +
                 fixed(nulls.largest_gain_percent, 1) + " %; p = " + significant(nulls.p_value, 2) +
                 " for the error reduction on the measured logs.");
}

void add_errors(Page& page, const Diagnosis& d) {
  page.section("Method and evidence");
  page.paragraph(
      "The given model was evaluated first, then recalibrated (same structure, all parameters fitted), then "
      "extended cause by cause. Each model was refitted without some blocks and simulated on them from the "
      "start of the log. Intervals follow from a block bootstrap.");
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
        "The error reduction does not hold for other logs: with whole logs held out, the error changes "
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
  page.paragraph("The refit absorbed part of the effect and made the model unphysical:");
  page.list(signs);
}

void add_named(Page& page, const Diagnosis& d) {
  if (!d.partial.empty())
    page.paragraph("These causes explain part of the error, but too little to be reported as its cause.");
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
    page.paragraph("The recalibrated model leaves no unexplained error, so no cause was searched for.");
  if (d.unexplained_error.present)
    page.paragraph("Unexplained share of the error: " + fixed(d.unexplained_percent, 1) + " %." +
                   (d.evidence && is_extended(d)
                        ? " After the extension: " + dependence_sentence(d.evidence->extended)
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
  page.section("Limits of the data");
  page.list(d.warnings);
}

}  // namespace softgrip::sysid
