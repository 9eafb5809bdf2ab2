#include "sysid/diagnosis/report/report.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/numbers.h"
#include "model/catalogue.h"
#include "model/file/model_file.h"
#include "sysid/diagnosis/causes/twins.h"
#include "sysid/diagnosis/report/report_figures.h"
#include "sysid/diagnosis/report/report_gauge.h"
#include "sysid/diagnosis/report/report_tables.h"
#include "sysid/diagnosis/verdict/budget.h"
#include "sysid/identification/log_figures.h"
#include "sysid/pages/page.h"
#include "sysid/pages/provenance.h"

namespace softgrip::sysid {
namespace {

/// Logs whose figures are shown, the worst first.
constexpr std::size_t logs_shown = 3;
constexpr std::size_t conditions_shown = 6;

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

std::string range(const Spread& s, int decimals) {
  return fixed(s.value, decimals) + " % (" + fixed(s.lower, decimals) + " to " + fixed(s.upper, decimals) +
         ")";
}

const ConditionEvidence* find(const ResidualEvidence& evidence, const std::string& id) {
  const auto found = std::find_if(evidence.conditions.begin(), evidence.conditions.end(),
                                  [&](const ConditionEvidence& e) { return e.condition.id == id; });
  return found == evidence.conditions.end() ? nullptr : &*found;
}

void add_logs(Page& page, const Diagnosis& d) {
  std::vector<std::size_t> order(d.records.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto mean_square = [&](std::size_t k) {
    double sum = 0, count = 0;
    for (const double r : d.recalibrated.residual_mm[k]) {
      if (std::isnan(r)) continue;
      sum += r * r;
      count += 1;
    }
    return count > 0 ? sum / count : 0;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return mean_square(a) > mean_square(b); });
  for (std::size_t i = 0; i < std::min(logs_shown, order.size()); ++i) {
    const std::size_t k = order[i];
    page.figure(diagnosis_overlay(d, k), d.records[k].name +
                                             ": measured against the models over time, and reading minus "
                                             "model. Wrong samples are left out.");
    page.figure_row({diagnosis_loops(d, k), errors_by_pressure(d, k)},
                    d.records[k].name + ": hysteresis loops, and the error over the pressure.");
  }
  if (order.size() > logs_shown) {
    page.paragraph("Shown are the " + std::to_string(logs_shown) + " logs with the largest errors of " +
                   std::to_string(order.size()) + ".");
  }
}

void add_conditions(Page& page, const Diagnosis& d) {
  const Evidence& evidence = *d.evidence;
  page.subsection("On what the error depends");
  page.paragraph("After recalibration: " + dependence_sentence(evidence.recalibrated));
  page.table(condition_table(evidence, is_extended(d)));
  std::vector<Chart> row;
  std::size_t shown = 0;
  for (const ConditionEvidence& e : evidence.recalibrated.conditions) {
    if (!e.condition.why_not.empty() || shown == conditions_shown) continue;
    if (shown >= 2 && !e.clear) continue;
    row.push_back(condition_chart(e, is_extended(d) ? find(evidence.extended, e.condition.id) : nullptr));
    ++shown;
    if (row.size() < 2) continue;
    page.figure_row(row, "");
    row.clear();
  }
  if (!row.empty()) page.figure_row(row, "");
  page.paragraph(
      "Mean errors of the recalibrated model with 95 % intervals. The dashed lines, where there are any, are "
      "those of the extended model: what it explains becomes flat. Position is the model's, for a reading "
      "shares its noise with the error.");
  page.paragraph(
      "The errors resemble each other over " + significant(evidence.recalibrated.memory_s, 2) +
      " s; the tests therefore give random signs to whole blocks of " +
      significant(evidence.recalibrated.block_s, 3) + " s (" + std::to_string(evidence.recalibrated.blocks) +
      " of them) and ask how often means would differ as much. Shares are judged on blocks outside "
      "the means and overlap: conditions that go together share what they explain.");
}

void add_wrong(Page& page, const Diagnosis& d) {
  page.section("What is wrong");
  page.table(rmse_table(d));
  add_logs(page, d);
  if (!d.evidence) return;
  add_conditions(page, d);
  const SpectrumEvidence& s = d.evidence->recalibrated.spectrum;
  if (s.why_not.empty()) {
    const bool line = s.p_value < 0.01;
    page.figure(spectrum_chart(d),
                line ? "Spectrum of the error. The strongest line that the command does not have: " +
                           significant(s.peak_hz, 4) + " Hz, amplitude " +
                           significant(s.peak_amplitude_mm, 2) + " mm (p " + significant(s.p_value, 2) + ")."
                     : "Spectrum of the error. No line stands out that the command does not have.");
  }
  if (d.evidence->unphysical.empty()) return;
  page.subsection("What recalibration did to the model");
  page.paragraph("New parameters absorbed part of the effect and bent the model in doing so:");
  std::vector<std::string> items;
  for (const UnphysicalSign& sign : d.evidence->unphysical) items.push_back(sign.sentence);
  page.list(items);
}

/// Why the rivals of a cause stand beside it.
std::string rivalry(const NamedCause& named, const model::Model& extended) {
  std::string alike, twin;
  for (const Cause& rival : named.rivals) {
    if (are_twins(named.cause, rival, extended)) {
      twin = rival.id;
    } else {
      alike += (alike.empty() ? "" : ", ") + std::string(rival.id);
    }
  }
  std::string text;
  if (!alike.empty())
    text = "These logs cannot tell it from " + alike +
           ": each explains as much in its place, within one standard error. ";
  if (!twin.empty())
    text +=
        "No command can tell it from " + twin +
        ": both bend the readings over the displacement, the one before the load and the other behind it, "
        "and how well the form of each meets these logs says nothing about where the bend is.";
  return text;
}

void add_cause(Page& page, const NamedCause& named, const Diagnosis& d) {
  const model::BlockInfo& info = model::catalogue()[named.block_type].info;
  page.subsection(std::string(named.cause.title));
  std::string meaning(info.meaning);
  if (!meaning.empty() && meaning.back() != '.') meaning += '.';
  page.paragraph(meaning + " Station: " + std::string(model::name_of(info.station)) +
                 "; id: " + std::string(named.cause.id) +
                 ". Held-out gain over the model without it: " + range(named.heldout_gain_percent, 1) + ".");
  if (!named.rivals.empty()) page.paragraph(rivalry(named, d.extended.point.model));
  if (!named.candidates.empty())
    page.table(candidate_table(named.candidates, &named, d.extended_rmse_mm, "What was tried in its place"));
}

/// How often the search finds something where nothing is.
void add_null_calibration(Page& page, const NullCalibration& nulls) {
  page.paragraph(
      "Searched in the same way, " + std::to_string(nulls.campaigns) +
      " campaigns in which the recalibrated model and correlated noise are all there is gave a name in " +
      std::to_string(nulls.named) + " cases, with a gain of at most " + fixed(nulls.largest_gain_percent, 1) +
      " %; p = " + significant(nulls.p_value, 2) + " for the gain on the measured logs.");
}

void add_causes(Page& page, const Diagnosis& d) {
  page.section(d.verdict == Verdict::unexplained ? "What was tried" : "Causes");
  if (d.null_calibration) add_null_calibration(page, *d.null_calibration);
  if (!d.partial.empty())
    page.paragraph("These explain part of the structure, but too little to be named the cause.");
  for (const NamedCause& named : d.causes) add_cause(page, named, d);
  for (const NamedCause& named : d.partial) add_cause(page, named, d);
  if (!d.rejected.empty()) {
    page.table(candidate_table(d.rejected, nullptr, d.extended_rmse_mm,
                               d.causes.empty() && d.partial.empty() ? "No cause gained anything"
                                                                     : "One more cause gained nothing"));
  } else if (d.causes.empty() && d.partial.empty()) {
    page.paragraph("The recalibrated model leaves no structure, so no cause was looked for.");
  }
}

void add_extension(Page& page, const Diagnosis& d, const model::Model& given) {
  page.section(is_extended(d) ? "The extension" : "The parameters");
  for (const auto* list : {&d.causes, &d.partial}) {
    for (const NamedCause& named : *list) {
      const model::BlockInfo& info = model::catalogue()[named.block_type].info;
      page.subsection(std::string(info.title));
      page.code(info.equation);
      page.table(cause_parameter_table(named));
    }
  }
  page.subsection("What moved in the parameters");
  page.table(moved_table(d, given));
}

void add_gain(Page& page, const Diagnosis& d) {
  if (!is_extended(d)) return;
  page.section("The gain, held out");
  page.paragraph("The extended model's error is smaller than the recalibrated one's by " + range(d.gain, 1) +
                 ": both refitted without stretches of the logs and judged there, simulated from the logs' "
                 "true starts; the interval by drawing whole stretches anew.");
  if (d.recalibrated_other_logs_rmse_mm && d.extended_other_logs_rmse_mm) {
    const double before = *d.recalibrated_other_logs_rmse_mm, after = *d.extended_other_logs_rmse_mm;
    page.paragraph("With whole logs held out the error goes from " + significant(before, 3) + " to " +
                   significant(after, 3) + " mm (" + fixed(100 * (1 - after / before), 1) + " %)." +
                   (after < before ? "" : " The gain does not carry over to logs that were not fitted."));
  }
  page.figure(gain_chart(d), "Held-out errors beside the readings' noise.");
}

void add_left(Page& page, const Diagnosis& d) {
  page.section("What is left");
  page.paragraph("Share of the structure that stays unexplained: " + fixed(d.unexplained_percent, 1) + " %.");
  if (d.evidence && is_extended(d) && d.structure_left.present)
    page.paragraph("After the extension: " + dependence_sentence(d.evidence->extended));
}

void add_limits(Page& page, const DiagnosisReport& report) {
  page.section("What these data cannot tell");
  std::vector<std::string> items = report.result.warnings;
  for (const Log& log : report.logs) {
    for (const LogNote& note : log.notes) {
      items.push_back(log.name + (note.line > 0 ? ", line " + std::to_string(note.line) : "") + ": " +
                      note.text);
    }
  }
  if (items.empty()) {
    page.paragraph("Nothing in these logs limits what can be told of the causes that were tried.");
  } else {
    page.list(items);
  }
}

void add_next(Page& page, const DiagnosisReport& report) {
  if (!report.advice.empty()) {
    page.section("What would tell more");
    page.list(report.advice);
  }
  if (!report.next_experiment) return;
  const ProposedExperiment& next = *report.next_experiment;
  page.section("The next experiment");
  std::string ids;
  for (const std::string& id : next.separates) ids += (ids.empty() ? "" : ", ") + id;
  page.paragraph((next.waveform.empty() ? "" : next.waveform + ". ") + "It separates " + ids +
                 ": on it they differ by " + significant(next.predicted_separation_sigma, 3) +
                 " standard deviations of the noise, each refitted to the other. " +
                 significant(next.rig_minutes, 2) + " minutes of rig time; run it with " + next.file + ".");
}

/// Where the misfit goes, from the given model to the noise.
void add_budget(Page& page, const Diagnosis& d) {
  const auto text = [](double mm2) { return significant(mm2, 3); };
  const Budget budget = budget_of(d);
  page.section("The budget of the misfit");
  Table table{"Mean squares of held-out readings; what one finding takes is measured by leaving it out",
              {"", "mean square [mm²]", "95 %", "inclusion"},
              {false, true, true, true},
              {}};
  table.rows.push_back({"as given", text(budget.as_given), "", ""});
  table.rows.push_back({"recalibrated", text(budget.recalibrated), "", ""});
  for (const NamedCause& named : d.causes) {
    table.rows.push_back({"– " + std::string(named.cause.title), text(named.gain_mm2.value),
                          text(named.gain_mm2.lower) + " to " + text(named.gain_mm2.upper),
                          fixed(named.inclusion, 2)});
  }
  table.rows.push_back({"extended", text(budget.extended), "", ""});
  table.rows.push_back({"of which noise", text(budget.noise), "", ""});
  table.rows.push_back({"left", text(budget.left()), "", ""});
  page.table(table);
  if (!d.base.empty())
    page.paragraph("The given base does not hold; the extended model's is: " + d.base + ".");
}

}  // namespace

std::string diagnosis_html(const DiagnosisReport& report) {
  const Diagnosis& d = report.result;
  Page page("Diagnosis of " + report.given.name, verdict_sentence(d), tone_of(d.verdict));
  auto provenance = provenance_of(
      report.logs, {{"given model", &report.given},
                    {is_extended(d) ? "extended model" : "recalibrated model", &d.extended_model}});
  provenance.emplace_back("verdict", name_of(d.verdict));
  provenance.emplace_back("seed", std::to_string(report.seed));
  provenance.emplace_back("time taken", significant(d.wall_s, 3) + " s");
  page.provenance(std::move(provenance));
  add_budget(page, d);
  add_wrong(page, d);
  add_causes(page, d);
  if (d.gauge) add_gauge_section(page, *d.gauge);
  add_extension(page, d, report.given);
  add_gain(page, d);
  add_left(page, d);
  add_limits(page, report);
  add_next(page, report);
  page.section("Model file");
  page.code(model::to_yaml(d.extended_model));
  return page.to_html();
}

}  // namespace softgrip::sysid
