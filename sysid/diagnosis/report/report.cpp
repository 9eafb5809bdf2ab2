#include "sysid/diagnosis/report/report.h"

#include <algorithm>
#include <cstddef>

#include "base/numbers.h"
#include "base/text.h"
#include "sysid/diagnosis/report/report_sections.h"

namespace softgrip::sysid {
namespace {

Tone tone_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::adequate:
    case Verdict::recalibrate:
    case Verdict::cause_found:
      return Tone::good;
    case Verdict::ambiguous:
    case Verdict::partly_explained:
      return Tone::doubtful;
    case Verdict::unexplained:
      return Tone::bad;
  }
  return Tone::bad;
}

/// Largest number of parameters per cause in the first part of the report.
constexpr std::size_t parameters_shown = 6;

/// Returns a list of terms that describe the data of the diagnosis. The hashes of the logs are not part of
/// this list; they are in the appendix.
Terms looked_at(const DiagnosisReport& report) {
  const Diagnosis& d = report.result;
  std::size_t samples = 0;
  double duration_s = 0;
  for (const Log& log : report.logs) {
    samples += log.size();
    if (!log.time_s.empty()) duration_s += log.time_s.back() - log.time_s.front();
  }
  const std::string logs =
      report.logs.size() == 1 ? report.logs.front().name : std::to_string(report.logs.size()) + " logs";
  return {{"given model", report.given.name},
          {is_extended(d) ? "extended model" : "recalibrated model", d.extended_model.name},
          {"data", logs + ", " + std::to_string(samples) + " samples, " + significant(duration_s, 4) +
                       " s; noise of the readings " + significant(d.noise_mm, 3) + " " +
                       std::string(model::name_of(d.extended_model.output_unit))},
          {"software", software_and_version()}};
}

void add_next(Page& page, const DiagnosisReport& report) {
  const NextExperiment& next = report.experiment;
  if (next.advice.empty() && !next.best) return;
  page.section("Recommended measurements");
  page.list(next.advice);
  if (!next.best) return;
  const std::string& about = next.best->waveform.about;
  page.paragraph("Next experiment: " + (about.empty() ? "" : about + ". ") + "This experiment separates " +
                 with_commas(next.separates) +
                 ". Even if each of these explanations is refitted to the response of the other explanation, "
                 "their responses differ by " +
                 significant(next.predicted_separation_sigma, 3) +
                 " standard deviations of the noise. The experiment takes " +
                 significant(next.best->minutes, 2) +
                 " minutes of motion on the rig; sequence file: " + experiment_file + ".");
}

void add_found(Page& page, const DiagnosisReport& report) {
  const Diagnosis& d = report.result;
  page.section("Results");
  page.figure(budget_figure(d));
  if (!shown_causes(d).empty()) {
    page.figure(forest_figure(d));
    page.table(cause_parameter_table(d, parameters_shown));
  }
  if (!d.base.empty())
    page.paragraph(
        "The structure of the given model is not sufficient. The extended model has this structure: " +
        d.base + ".");
  page.figure(chain_figure(d.extended_model, report.given));
  page.figure(error_figure(d, logs_by_gain(d).front()));
  if (const auto looped = first_with_loops(d)) page.figure(loops_figure(d, *looped));
  if (!report.closed_loop) return;
  // A figure with the PID controller alone shows nothing about the models, so it is left out.
  if (report.closed_loop->schemes.size() > 1) {
    page.figure(closed_loop_figure(*report.closed_loop));
  } else {
    page.paragraph("No controller with a model was simulated in closed loop (" +
                   report.closed_loop->reference + "):");
  }
  page.list(report.closed_loop->notes);
}

}  // namespace

Page diagnosis_page(const DiagnosisReport& report) {
  const Diagnosis& d = report.result;
  Page page("Diagnosis of " + report.given.name, verdict_sentence(d), tone_of(whole_verdict(d)));
  page.provenance(looked_at(report));
  add_found(page, report);
  if (d.in_valve) add_valve_section(page, *d.in_valve);
  add_next(page, report);
  add_reached(page, report);
  add_appendix(page, report);
  return page;
}

}  // namespace softgrip::sysid
