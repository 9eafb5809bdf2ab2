#include "tools/investigation/investigation.h"

#include "base/numbers.h"
#include "model/file/model_file.h"
#include "sysid/identification/log_report.h"
#include "sysid/pages/page.h"

namespace softgrip::tools {
namespace {

sysid::Tone tone_of(InvestigationEnd end) {
  switch (end) {
    case InvestigationEnd::settled:
      return sysid::Tone::good;
    case InvestigationEnd::unexplained:
    case InvestigationEnd::nothing_left:
    case InvestigationEnd::budget_spent:
      return sysid::Tone::doubtful;
    case InvestigationEnd::contact:
    case InvestigationEnd::not_as_asked:
    case InvestigationEnd::stopped:
    case InvestigationEnd::failed:
      break;
  }
  return sysid::Tone::bad;
}

}  // namespace

std::string investigation_html(const Investigation& investigation, const std::string& rig,
                               const std::string& closed_loop) {
  const sysid::Diagnosis& last = investigation.last;
  const std::string why =
      investigation.why.empty() ? "" : " The investigation ended: " + investigation.why + ".";
  sysid::Page page("Investigation on " + rig, sysid::verdict_sentence(last) + why,
                   tone_of(investigation.end));
  page.provenance(sysid::provenance_of(
      investigation.logs, {{"refitted", &last.recalibrated_model}, {"extended", &last.extended_model}}));
  page.section("Steps");
  page.paragraph(significant(investigation.spent_minutes, 3) + " of " +
                 significant(investigation.budget_minutes, 3) + " minutes on the rig were used.");
  page.table(result::table_of("Steps: diagnosis of all logs so far, and the experiment that followed",
                              investigation.steps));
  for (const InvestigationStep& step : investigation.steps) {
    page.section(step.folder);
    page.paragraph(step.sentence);
    if (step.answer) {
      page.paragraph("Then " + step.experiment +
                     " was run on the rig. The figures show the response of the rig and the prediction by "
                     "the extended model of this step:");
      sysid::add_log_figures(page, step.answer->records.front(), step.answer->scores.front());
    } else if (!step.experiment.empty()) {
      page.paragraph("Then the sensor was checked against a gauge: " + step.log);
    }
  }
  if (!closed_loop.empty()) {
    page.section("Closed loop");
    page.paragraph(closed_loop);
  }
  if (!last.warnings.empty()) {
    page.section("Limitations of the data");
    page.list(last.warnings);
  }
  page.section("Extended model");
  page.code(model::to_yaml(last.extended_model));
  return page.to_html();
}

}  // namespace softgrip::tools
