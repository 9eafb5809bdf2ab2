#include "sysid/identification/identify_report.h"

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "model/file/model_file.h"
#include "sysid/identification/combinations.h"
#include "sysid/identification/log_report.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {
namespace {

/// Limits for residuals that count as noise. At least one of two quantities must be below its limit: the RMSE
/// divided by the noise of the readings (fast_noise_mm()), or the magnitude of the correlation between
/// consecutive residuals.
constexpr double noise_factor = 1.3;
constexpr double hardly_correlated = 0.3;

double largest_percent(const Identification& r) {
  double largest = 0;
  for (const Score& s : r.scores) largest = std::max(largest, s.rmse_percent_of_span);
  return largest;
}

bool is_noise(const Identification& r) {
  return r.rmse_mm <= noise_factor * r.fast_noise_mm ||
         std::abs(r.noise.lag1_correlation) < hardly_correlated;
}

Tone tone_of(const Identification& r) {
  if (largest_percent(r) > bad_percent) return Tone::bad;
  return is_noise(r) && beta_over_gain(r.fitted) <= 1 && r.converged ? Tone::good : Tone::doubtful;
}

std::string logs_in_words(const Identification& r) {
  return r.scores.size() == 1 ? r.scores.front().name : std::to_string(r.scores.size()) + " logs";
}

std::string range(const std::optional<Interval>& interval, double value) {
  return interval ? text_of(*interval, value, " to ") : "";
}

Table estimate_table(const std::vector<Estimate>& list, std::string caption) {
  const bool profiled =
      std::any_of(list.begin(), list.end(), [](const Estimate& e) { return e.profile95.has_value(); });
  const bool formulas =
      std::any_of(list.begin(), list.end(), [](const Estimate& e) { return !e.formula.empty(); });
  Table table;
  table.caption = std::move(caption);
  table.header = {"name", "value", "95 % interval"};
  table.numeric = {false, true, true};
  if (profiled) {
    table.header.emplace_back("95 % interval by profile likelihood");
    table.numeric.push_back(true);
  }
  table.header.insert(table.header.end(), {"unit", "identified", formulas ? "formula" : "note"});
  for (const Estimate& e : list) {
    std::vector<std::string> row{e.name, significant(e.value, 5), range(e.ci95, e.value)};
    if (profiled) row.push_back(range(e.profile95, e.value));
    const std::string identified = e.identifiable ? "yes" : e.free || !e.formula.empty() ? "no" : "";
    row.insert(row.end(), {e.unit, identified, formulas && e.note.empty() ? e.formula : e.note});
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Returns a chart that shows the autocorrelation of the errors of the first log. The lags go up to a tenth
/// of the length of this log.
Chart correlation_chart(const Identification& r) {
  Chart chart;
  chart.width = 380;
  chart.height = 240;
  chart.title = "correlation of the errors";
  chart.x.label = "lag [s]";
  chart.y.lower = -1;
  chart.y.upper = 1;
  Series series;
  series.style = Series::Style::line;
  series.colour = Colour::error;
  const Score& s = r.scores.front();
  const Record& record = r.records.front();
  const std::size_t reach = std::max<std::size_t>(2, s.error_mm.size() / 10);
  const double interval_s = record.mean_interval_s();
  for (std::size_t lag = 0; lag < reach; lag += std::max<std::size_t>(1, reach / 200)) {
    double product = 0;
    double square = 0;
    for (std::size_t i = lag; i < s.error_mm.size(); ++i) {
      if (!std::isfinite(s.error_mm[i]) || !std::isfinite(s.error_mm[i - lag])) continue;
      product += s.error_mm[i] * s.error_mm[i - lag];
      square += s.error_mm[i] * s.error_mm[i];
    }
    series.x.push_back(static_cast<double>(lag) * interval_s);
    series.y.push_back(square > 0 ? product / square : 0);
  }
  chart.series = {series};
  return chart;
}

Chart multistart_chart(const Identification& r) {
  Chart chart;
  chart.width = 380;
  chart.height = 240;
  chart.title = "results of the start points";
  chart.x.label = "start points, best first";
  chart.y.label = model::in_unit("RMSE [mm]", r.model.output_unit);
  std::vector<double> sorted = r.multistart.rmse_mm;
  std::sort(sorted.begin(), sorted.end());
  Series series;
  series.style = Series::Style::points;
  series.width = 3;
  series.colour = Colour::model;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    series.x.push_back(static_cast<double>(i + 1));
    series.y.push_back(sorted[i]);
  }
  chart.y.logarithmic = sorted.front() > 0;
  chart.series = {series};
  return chart;
}

void add_limits(Page& page, const Identification& r) {
  page.section("Limits of the data");
  std::vector<std::string> items;
  for (const Estimate& e : r.parameters) {
    const bool kept = !e.free && e.note.find("alpha") == std::string::npos;
    if (!e.identifiable && !kept)
      items.push_back(e.name + (e.note.empty() ? ": the confidence interval is too wide" : ": " + e.note));
  }
  for (const LooseDirection& loose : r.loose) {
    std::string text = "Together, ";
    for (std::size_t i = 0; i < loose.names.size(); ++i) {
      text += (i == 0 ? "" : ", ") + loose.names[i] + " (" + significant(loose.weights[i], 2) + ")";
    }
    items.push_back(text + " may change by " + significant(loose.deviation, 2) +
                    " in the scale of the fit (logarithms of stiffnesses and dampings), and the error does "
                    "not increase.");
  }
  if (items.empty()) {
    page.paragraph("These logs determine every free parameter.");
  } else {
    page.list(items);
  }
}

void add_residuals(Page& page, const Identification& r) {
  page.section("Errors and search");
  const std::string unit(model::name_of(r.model.output_unit));
  page.paragraph(
      "Sample-to-sample noise of the readings " + significant(r.fast_noise_mm, 3) + " " + unit + "; RMSE " +
      significant(r.rmse_mm, 3) + " " + unit + "; correlation of the errors from one sample to the next " +
      significant(r.noise.lag1_correlation, 3) +
      ". For the confidence intervals, the samples are equivalent to " + fixed(r.noise.effective_samples, 0) +
      " independent samples (autoregressive model of order " + std::to_string(r.noise.coefficients.size()) +
      ").");
  if (r.huber_mm > 0) {
    page.paragraph("Robust fit: errors larger than " + significant(r.huber_mm, 3) + " " + unit +
                   " contribute linearly, not quadratically, to the loss of the fit.");
  }
  page.figure({"errors and search",
               "Autocorrelation of the errors, and the final error of the search from each start point: " +
                   fixed(100 * r.multistart.share_at_best, 0) + " % of " +
                   std::to_string(r.multistart.starts) + " start points led to the best fit.",
               {{correlation_chart(r), multistart_chart(r)}}});
  if (r.exponent_rmse_mm.size() > 1) {
    Table table{"Tested exponents of the hysteresis", {"exponent", "RMSE [" + unit + "]"}, {true, true}, {}};
    for (const auto& [exponent, rmse_mm] : r.exponent_rmse_mm) {
      table.rows.push_back({std::to_string(exponent), significant(rmse_mm, 4)});
    }
    page.table(table);
  }
}

/// Adds a section with the candidate structures and with the error reduction by each component of the chosen
/// structure.
void add_structure(Page& page, const StructureEvidence& s, model::OutputUnit unit) {
  const std::string fitted = model::in_unit("RMSE on the fitted readings [mm]", unit);
  const std::string held_out = model::in_unit("RMSE on the held-out blocks [mm]", unit);
  page.section("Structure");
  page.paragraph(
      "Every structure was fitted to all readings. In addition, each structure was fitted five times, each "
      "time without "
      "a different fifth of " +
      std::to_string(s.blocks) +
      " interleaved blocks. The structures were compared by their errors on the omitted blocks. The simplest "
      "structure was chosen whose error is not significantly larger than the smallest error. Extensions "
      "of this structure were tried, and were added if they reduced the error significantly.");
  Table tried{"Tested structures, the simplest structure first",
              {"structure", "", fitted, held_out},
              {false, false, true, true},
              {}};
  for (const StructureEvidence::Candidate& c : s.candidates) {
    tried.rows.push_back({c.description, c.chosen ? "chosen" : "", significant(c.rmse_mm, 4),
                          significant(c.heldout_rmse_mm, 4)});
  }
  page.table(tried);
  if (!s.ablation.empty()) {
    Table without{"Error of the chosen structure if one component is removed",
                  {"without", fitted, held_out},
                  {false, true, true},
                  {}};
    for (const StructureEvidence::Ablation& a : s.ablation)
      without.rows.push_back({a.without, significant(a.rmse_mm, 4), significant(a.heldout_rmse_mm, 4)});
    page.table(without);
  }
  if (!s.valve) return;
  page.paragraph(
      "The pressure was measured, so the model consists of a valve (command to pressure) and an actuator "
      "(pressure to displacement). Valve: dead time " +
      significant(s.valve->delay_s, 3) + " s, time constant " +
      significant(s.valve->filling_time_constant_s, 3) + " s (filling) and " +
      significant(s.valve->venting_time_constant_s, 3) + " s (venting); RMSE " +
      significant(s.valve->rmse_kpa, 3) + " kPa, " + significant(s.valve->rmse_percent_of_range, 2) +
      " % of the measured range (noise " + significant(s.valve->noise_kpa, 2) + " kPa).");
}

void add_notes(Page& page, const std::vector<Log>& logs) {
  std::vector<std::string> items;
  for (const Log& log : logs) {
    for (const LogNote& note : log.notes) {
      items.push_back(log.name + (note.line > 0 ? ", line " + std::to_string(note.line) : "") + ": " +
                      note.text);
    }
  }
  if (items.empty()) return;
  page.section("Notes on the logs");
  page.list(items);
}

}  // namespace

std::string verdict_of(const Identification& r) {
  const std::string logs = logs_in_words(r);
  const std::string size =
      "RMSE of " + significant(r.rmse_mm, 3) + " " + std::string(model::name_of(r.model.output_unit)) + ", " +
      (r.scores.size() == 1 ? significant(largest_percent(r), 2) + " % of the span of the log"
                            : "at most " + significant(largest_percent(r), 2) + " % of the span of each log");
  if (largest_percent(r) > bad_percent) {
    return "The model does not explain " + logs + ": " + size + ".";
  }
  std::string text = is_noise(r) ? "The model explains " + logs + " down to the noise: " + size + "."
                                 : "The model reproduces " + logs + " with an " + size +
                                       ", but the remaining error is larger than the noise. Search for the "
                                       "cause of this error with softgrip diagnose.";
  if (const double ratio = beta_over_gain(r.fitted); ratio > 1) text += " " + wrong_way_sentence(ratio) + ".";
  if (!r.converged) text += " The search stopped before convergence.";
  return text;
}

Page identify_page(const IdentifyReport& report) {
  const Identification& r = report.result;
  Page page("Identification: " + r.model.name + " from " + logs_in_words(r), verdict_of(r), tone_of(r));
  auto provenance = provenance_of(report.logs, {{"start", &report.start}, {"identified model", &r.model}});
  provenance.emplace_back("seed of the start points", std::to_string(report.seed));
  page.provenance(std::move(provenance));
  if (!r.warnings.empty()) {
    page.section("Warnings");
    page.list(r.warnings);
  }
  page.section("Fit");
  page.table(score_table(r.records, r.scores));
  if (!r.held_out.empty()) {
    Table table = score_table(r.records, r.held_out);
    table.caption =
        "Held-out part at the end of each log, predicted by a simulation from the start of the log";
    page.table(table);
  }
  if (r.structure) add_structure(page, *r.structure, r.model.output_unit);
  for (std::size_t i = 0; i < r.scores.size(); ++i) add_log_figures(page, r.records[i], r.scores[i]);
  if (!report.validation.empty()) {
    page.section("Validation");
    page.paragraph("Prediction of the logs that were not fitted.");
    page.table(score_table(report.validation_records, report.validation));
    for (std::size_t i = 0; i < report.validation.size(); ++i) {
      add_log_figures(page, report.validation_records[i], report.validation[i]);
    }
  }
  page.section("Parameters");
  page.table(estimate_table(r.parameters, ""));
  if (!r.starts.empty()) page.table(estimate_table(r.starts, "Initial states of the logs"));
  page.section("Combinations of parameters");
  page.paragraph("Sums and ratios of parameters: gains, time constants and limits that the data determine.");
  page.table(estimate_table(r.combinations, ""));
  add_limits(page, r);
  add_residuals(page, r);
  add_notes(page, report.logs);
  page.section("Model file");
  page.code(model::to_yaml(r.model));
  return page;
}

}  // namespace softgrip::sysid
