#include "sysid/diagnosis/report/report_sections.h"

#include <string>
#include <vector>

#include "base/numbers.h"
#include "model/catalogue.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/evidence/evidence.h"

namespace softgrip::sysid {
namespace {

std::string range(const Spread& s, int decimals) {
  return fixed(s.value, decimals) + " % (" + fixed(s.lower, decimals) + " to " + fixed(s.upper, decimals) +
         ")";
}

/// Returns the text that explains why the report lists alternatives to a cause.
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
    text = "These logs cannot separate this cause from " + alike +
           ", because each of these causes explains the error equally well (within one standard error). ";
  if (!indistinguishable.empty())
    text +=
        "No command can separate this cause from " + indistinguishable +
        ", because each of these causes makes the readings a nonlinear function of the displacement. A "
        "better fit of one of these causes therefore does not show if the finger or the sensor is nonlinear.";
  return text;
}

/// Adds a paragraph about the search in simulated data without a cause. The paragraph states how often the
/// search names a cause in these data.
void add_null_calibration(Page& page, const NullCalibration& nulls) {
  page.paragraph("The same search was applied to " + std::to_string(nulls.campaigns) +
                 " simulated data sets that contain only the recalibrated model and correlated noise. The "
                 "search named a cause in " +
                 std::to_string(nulls.named) + " of these data sets, with an error reduction of at most " +
                 fixed(nulls.largest_gain_percent, 1) + " %; p = " + significant(nulls.p_value, 2) +
                 " for the error reduction on the measured logs.");
}

void add_errors(Page& page, const Diagnosis& d) {
  page.section("Method and evidence");
  page.paragraph(
      "The given model was evaluated first, then recalibrated (same structure, all parameters fitted), then "
      "extended cause by cause. For the held-out error, each model was refitted without some blocks of the "
      "logs. The error of the model was then evaluated on these held-out blocks, in a simulation from the "
      "start of the "
      "log. The intervals follow from a "
      "block bootstrap.");
  page.table(rmse_table(d));
  page.figure(runs_figure(d));
  if (is_extended(d) && d.extended_rmse_mm < d.recalibrated_rmse_mm)
    page.paragraph(
        "The held-out error of the extended model is smaller than the held-out error of the recalibrated "
        "model by " +
        range(d.gain, 1) + ".");
  if (!d.recalibrated_other_logs_rmse_mm || !d.extended_other_logs_rmse_mm || !is_extended(d)) return;
  const double before = *d.recalibrated_other_logs_rmse_mm;
  const double after = *d.extended_other_logs_rmse_mm;
  if (after >= before)
    page.paragraph(
        "The extension does not reduce the error of logs that were not fitted: if whole logs are held out, "
        "the error changes from " +
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
  page.paragraph(
      "The recalibration absorbed a part of the effect that the given model lacks, and made these parameters "
      "of the model unphysical:");
  page.list(signs);
}

void add_named(Page& page, const Diagnosis& d) {
  if (!d.partial.empty())
    page.paragraph(
        d.loop_bands_kpa
            ? "These causes explain the readings in simulations. They are not reported as the "
              "cause of the error, because the test of the closed loop shows that the valve sticks."
            : "These causes explain a part of the error, but too small a part to be reported as "
              "the cause of the error.");
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
    page.paragraph("The recalibrated model explains the logs completely, so no search for a cause was made.");
  if (d.unexplained_error.present)
    page.paragraph("Share of the error that remains unexplained: " + fixed(d.unexplained_percent, 1) + " %." +
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
