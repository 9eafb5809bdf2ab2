#include "sysid/diagnosis/report/report_sections.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/numbers.h"
#include "model/catalogue.h"
#include "model/file/model_file.h"
#include "sysid/diagnosis/evidence/evidence.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {
namespace {

/// Largest number of logs that the report shows in figures. The log in the first part of the report is one of
/// them.
constexpr std::size_t logs_shown = 3;

void add_other_logs(Page& page, const Diagnosis& d) {
  const std::vector<std::size_t> order = logs_by_gain(d);
  for (std::size_t i = 1; i < std::min(logs_shown, order.size()); ++i) {
    page.figure(error_figure(d, order[i]));
    if (has_loops(d.records[order[i]]) && order[i] != first_with_loops(d))
      page.figure(loops_figure(d, order[i]));
  }
  if (order.size() > logs_shown)
    page.paragraph("The figures show the " + std::to_string(logs_shown) +
                   " logs with the largest error reduction, out of " + std::to_string(order.size()) + ".");
}

void add_conditions(Page& page, const Diagnosis& d) {
  if (!d.evidence) return;
  const ResidualEvidence& e = d.evidence->recalibrated;
  page.subsection("Conditions");
  page.table(condition_table(*d.evidence, is_extended(d)));
  page.paragraph(
      "The correlation time of the residual is " + significant(e.memory_s, 2) +
      " s. The tests therefore apply random signs to whole blocks of " + significant(e.block_s, 3) + " s (" +
      std::to_string(e.blocks) +
      " blocks). The tests count how often random signs give differences between the means that are as "
      "large as the measured differences. The means are computed from one part of the blocks, and "
      "the share of each condition is evaluated on the other blocks. If conditions are "
      "correlated, their shares overlap. A dependence is significant if p < 0.02 and the "
      "condition explains at least 5 % of the residual variance beyond the noise.");
  if (e.spectrum.why_not.empty() && !is_clear(e.spectrum.p_value, e.spectrum.share_percent))
    page.figure(spectrum_figure(d));
}

void add_model(Page& page, const DiagnosisReport& report) {
  const Diagnosis& d = report.result;
  page.subsection("Parameters");
  page.table(moved_table(d, report.given));
  if (!d.causes.empty() || !d.partial.empty())
    page.table(cause_parameter_table(d, std::numeric_limits<std::size_t>::max()));
  for (const auto* list : {&d.causes, &d.partial}) {
    for (const NamedCause& named : *list) {
      const model::BlockInfo& info = model::catalogue()[named.block_type].info;
      page.paragraph(std::string(info.title) + ":");
      page.code(info.equation);
    }
  }
  page.paragraph("The model file of " + d.extended_model.name + ":");
  page.code(model::to_yaml(d.extended_model));
}

void add_sources(Page& page, const DiagnosisReport& report) {
  const Diagnosis& d = report.result;
  page.subsection("Sources");
  Terms terms = provenance_of(
      report.logs, {{"given model", &report.given},
                    {is_extended(d) ? "extended model" : "recalibrated model", &d.extended_model}});
  terms.emplace_back("verdict", name_of(d.verdict));
  terms.emplace_back("seed", std::to_string(report.seed));
  terms.emplace_back("time taken", significant(d.wall_s, 3) + " s");
  page.terms(terms);
  std::vector<std::string> notes;
  for (const Log& log : report.logs) {
    for (const LogNote& note : log.notes)
      notes.push_back(log.name + (note.line > 0 ? ", line " + std::to_string(note.line) : "") + ": " +
                      note.text);
  }
  page.list(notes);
}

}  // namespace

void add_appendix(Page& page, const DiagnosisReport& report) {
  page.appendix("Appendix");
  for (Table& table : candidate_tables(report.result)) page.table(std::move(table));
  add_conditions(page, report.result);
  add_model(page, report);
  add_sources(page, report);
  if (report.result.records.size() > 1) page.subsection("Figures of the other logs");
  add_other_logs(page, report.result);
}

}  // namespace softgrip::sysid
