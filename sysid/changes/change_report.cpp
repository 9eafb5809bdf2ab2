#include "sysid/changes/change_report.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/numbers.h"
#include "sysid/changes/healthy_runs.h"
#include "sysid/changes/next_steps.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {
namespace {

using result::decimals, result::Fields, result::list_of, result::number, result::shown, result::Table,
    result::Value;

Value interval_value(const std::optional<Interval>& interval) {
  return interval ? Value(Value::List{interval->lower, interval->upper}) : Value();
}

/// Returns the reduction of the whitened RMS error by a cause [%] with its interval. Both are null for a
/// cause without a fit.
Fields reduction_percent(const ChangeCause& cause) {
  if (!cause.reduction) return {{"value", Value()}, {"ci95", Value()}};
  const auto& [share, interval] = *cause.reduction;
  return {{"value", 100 * share},
          {"ci95", interval_value(Interval{100 * interval.lower, 100 * interval.upper})}};
}

Fields fields_of_cause(const ChangeCause& cause) {
  Fields parameters;
  for (std::size_t i = 0; i < cause.fitted.numbers.size(); ++i) {
    const EffectNumber& number = cause.fitted.effect.numbers[i];
    const Fields fitted{{"value", cause.intervals.values[i]},
                        {"ci95", interval_value(cause.intervals.numbers[i])}};
    parameters.emplace_back(number.name, fitted);
    parameters.emplace_back(number.formerly, fitted);  // an empty key is not written
  }
  const Fields size{{"what", cause.size.what},
                    {"value", cause.size.value},
                    {"unit", model::in_unit(cause.size.unit, cause.output_unit)},
                    {"ci95", interval_value(cause.intervals.size)}};
  const std::string unit = unit_of(cause.judged, cause.output_unit);
  const auto steps = next_steps(cause.id);
  return {{"id", "cause", cause.id},
          {"form", cause.fitted.effect.form},
          {"station", model::name_of(cause.station)},
          {"parameters", std::move(parameters)},
          {"size", "size", shown(size, size_text(cause))},
          {"", "95 % interval", interval_text(cause)},
          {"full_pressure", "effect at full pressure",
           shown(cause.full_pressure_mm, significant(cause.full_pressure_mm, 2) + " " + unit)},
          {"effect_rms", cause.effect_mm},
          {"unit", unit},
          {"share_percent", "share of the error [%]", decimals(cause.share_percent, 0)},
          {"gain", Fields{{"value", cause.gain}, {"ci95", interval_value(cause.gain_interval)}}},
          {"heldout_error_reduction_percent", reduction_percent(cause)},
          {"heldout_gain_percent", reduction_percent(cause)},  // this key is deprecated
          {"next_steps", Value::List{steps[0], steps[1]}},
          {"", "alternatives", cause.alternatives}};
}

Fields fields_of_tried(const TriedCause& tried) {
  return {{"id", "cause", tried.id},
          {"form", tried.form},
          {"gain", "error reduction", decimals(tried.gain, 3)},
          {"healthy_gain", "error reduction in healthy runs", decimals(tried.healthy_gain, 3)},
          {"tolerance", "tolerance", decimals(tried.tolerance, 3)},
          {"rejected", "reason for the rejection", result::or_null(tried.rejected)}};
}

Fields fields_of_run(const RunLeft& run) {
  Value explained = number(run.explained, 3);
  if (run.is_healthy) explained.text = "-";
  return {{"run", "run", shown(run.run, name_with_state(run))},
          {"healthy", run.is_healthy},
          {"base_rms", "baseline model", number(run.base, 3)},
          {"explained_rms", "error with the causes", std::move(explained)}};
}

std::string named(const ChangeCause& cause) {
  std::string text = std::string(plain_words(cause.id)) + " (" + cause.id + ": " + size_text(cause) + ")";
  for (const std::string& alternative : cause.alternatives)
    text += ", or " + std::string(plain_words(alternative)) + " (" + alternative + ")";
  return text;
}

/// Returns the sentence for an unchanged verdict with one healthy log. The halves of a single log do not show
/// how much healthy runs differ, so the sentence states how large an error would be reported.
std::string unchanged_since_one_log(const std::vector<JudgedChange>& readings) {
  const auto share = [](const JudgedChange& judged) { return judged.later_mm / judged.allowed_mm; };
  const JudgedChange& nearest =
      *std::max_element(readings.begin(), readings.end(),
                        [&](const JudgedChange& a, const JudgedChange& b) { return share(a) < share(b); });
  const double ratio = nearest.later_mm / nearest.healthy_mm;
  if (!(ratio > 1) || !std::isfinite(ratio))
    return "Unchanged: the error of the later logs does not exceed the error between the two halves of the "
           "healthy log.";
  return "No change is detectable with one healthy log: the error of the later logs is " +
         significant(ratio, 2) +
         " times the error between the two halves of the healthy log, and a change is reported only above " +
         significant(nearest.allowed_mm / nearest.healthy_mm, 2) +
         " times. Record three or more healthy logs.";
}

std::string unchanged_sentence(const std::vector<JudgedChange>& readings) {
  const auto is_single = [](const JudgedChange& judged) { return judged.healthy_runs == 1; };
  for (const JudgedChange& judged : readings) {
    if (!judged.unusual_log.empty())
      return "Unchanged: only " + judged.unusual_log +
             " differs from the healthy logs by more than the healthy logs differ from each other. A change "
             "would appear in every later log.";
  }
  if (std::any_of(readings.begin(), readings.end(), has_unfamiliar_input))
    return "No change is detectable, but the input of the later logs is unlike the inputs of the healthy "
           "logs. Therefore, a larger difference from the baseline model is permitted.";
  if (!readings.empty() && std::all_of(readings.begin(), readings.end(), is_single))
    return unchanged_since_one_log(readings);
  std::string permitted;
  for (const JudgedChange& judged : readings)
    permitted += (permitted.empty() ? "" : " and ") + significant(judged.allowed_mm, 2) + " " +
                 unit_of(judged.judged, judged.output_unit);
  return "Unchanged: the errors of the later logs are within the error permitted for a further healthy run "
         "(" +
         permitted + ").";
}

std::string verdict_sentence(const ChangeDiagnosis& diagnosis) {
  if (diagnosis.verdict == ChangeVerdict::unchanged) return unchanged_sentence(diagnosis.readings);
  if (diagnosis.verdict == ChangeVerdict::unexplained && !diagnosis.another_command.empty())
    return "The later logs differ from the prediction of the baseline model, and no cause of the library "
           "explains the difference. The reason is a change of the finger or an error of the model, "
           "because no healthy log has the command of " +
           diagnosis.another_command + ".";
  if (diagnosis.verdict == ChangeVerdict::unexplained)
    return "The finger has changed since the healthy logs, but no cause of the library explains the change.";
  std::string text = "Change since the healthy logs: ";
  for (std::size_t i = 0; i < diagnosis.causes.size(); ++i)
    text += (i == 0 ? "" : "; and ") + named(diagnosis.causes[i]);
  if (diagnosis.verdict == ChangeVerdict::partly_explained)
    text += "; another part of the change remains unexplained";
  return text + ".";
}

/// Returns a sentence about the partial causes of each quantity, with a space before it.
std::string partial_sentences(const ChangeDiagnosis& diagnosis) {
  std::string text;
  for (const JudgedChange& judged : diagnosis.readings) {
    std::string causes;
    for (const ChangeCause& cause : diagnosis.partial) {
      if (cause.judged == judged.judged) causes += (causes.empty() ? "" : "; and ") + named(cause);
    }
    if (!causes.empty())
      text += " The following explanation accounts for only " + fixed(100 * share_explained(judged), 0) +
              " % of the additional error of the " + name_of(judged.judged) +
              ", so it is not reported as the cause: " + causes + ".";
  }
  return text;
}

/// Largest number of tested causes that the figure shows.
constexpr std::size_t drawn_causes = 8;

Tone tone_of(ChangeVerdict verdict) {
  if (verdict == ChangeVerdict::unchanged) return Tone::good;
  return verdict == ChangeVerdict::cause_found ? Tone::bad : Tone::doubtful;
}

void add_causes(Page& page, const ChangeDiagnosis& d) {
  page.section("Causes of the change");
  page.table(cause_table(d));
  for (const ChangeCause& cause : d.causes) {
    page.subsection("Next steps for " + cause.id);
    const auto steps = next_steps(cause.id);
    page.list({std::string(steps[0]), std::string(steps[1])});
  }
}

/// Returns the figure of the residuals in the later logs, without and with the causes. Each log has its own
/// chart.
Figure residual_figure(const JudgedChange& judged, bool explained) {
  std::vector<Chart> charts;
  for (std::size_t r = 0; r < judged.left.size(); ++r) {
    Chart chart;
    chart.title = judged.logs[r];
    chart.x.label = "time [s]";
    chart.y.label = std::string("residual [") + unit_of(judged.judged, judged.output_unit) + "]";
    chart.height = 180;
    Series before;
    before.label = "baseline model";
    before.colour = Colour::error;
    for (std::size_t b = 0; b < judged.left[r].size(); ++b) {
      before.x.push_back(middle_s(b, judged.bin_s));
      before.y.push_back(judged.left[r][b]);
    }
    Series after;
    after.label = "baseline model with the causes";
    after.x = before.x;
    after.y = judged.explained[r];
    after.colour = Colour::model;
    chart.series = {before};
    if (explained) chart.series.push_back(after);
    charts.push_back(std::move(chart));
  }
  return {std::string("residual ") + name_of(judged.judged),
          "Residual of the baseline model on the later logs. For comparison, the RMS residual on left-out "
          "healthy logs is " +
              significant(judged.healthy_mm, 2) + " " + unit_of(judged.judged, judged.output_unit) + ".",
          stacked(std::move(charts))};
}

Figure tried_figure(const JudgedChange& judged) {
  Chart chart;
  chart.title = name_of(judged.judged);
  chart.y.label = "error reduction";
  Series later, healthy, tolerance;
  later.label = "later logs";
  tolerance.label = "tolerance";
  healthy.label = "left-out healthy runs";
  later.style = Series::Style::bars;
  healthy.style = Series::Style::points;
  healthy.width = 4;
  healthy.colour = Colour::measured;
  tolerance.style = Series::Style::points;
  tolerance.width = 4;
  tolerance.colour = Colour::error;
  later.colour = Colour::model;
  for (std::size_t i = 0; i < std::min(drawn_causes, judged.tried.size()); ++i) {
    chart.x.categories.push_back(judged.tried[i].id);
    for (Series* series : {&later, &healthy, &tolerance}) series->x.push_back(static_cast<double>(i));
    later.y.push_back(std::max(0.0, judged.tried[i].gain));
    healthy.y.push_back(judged.tried[i].healthy_gain);
    tolerance.y.push_back(judged.tried[i].tolerance);
  }
  chart.series = {later, healthy, tolerance};
  return {std::string("tested causes ") + name_of(judged.judged),
          "Reduction of the whitened squared error per bin by each cause alone, for the later logs and for "
          "left-out healthy runs. A cause is reported only if its reduction exceeds the tolerance.",
          stacked({chart})};
}

/// Returns the figure of the RMS error of the baseline model in every run. The healthy runs come first.
Figure runs_figure(const JudgedChange& judged, bool explained) {
  std::vector<std::string> names;
  std::vector<double> before, after;
  for (const RunLeft& run : judged.runs) {
    names.push_back(name_with_state(run));
    before.push_back(run.base);
    after.push_back(run.is_healthy ? std::numeric_limits<double>::quiet_NaN() : run.explained);
  }
  Chart chart = chart_over(std::move(names));
  chart.y.label = std::string("error [") + unit_of(judged.judged, judged.output_unit) + "]";
  chart.series = {points_over_names("baseline model", Colour::error, std::move(before))};
  if (explained)
    chart.series.push_back(
        points_over_names("baseline model with the causes", Colour::model, std::move(after)));
  return {std::string("error by run ") + name_of(judged.judged),
          "RMS error of the baseline model in each run, after the mean error of the run is subtracted. To "
          "predict a healthy run, the model is fitted to the other healthy runs.",
          stacked({chart})};
}

void add_reading(Page& page, const JudgedChange& judged, const ChangeDiagnosis& d) {
  page.section(std::string("The ") + name_of(judged.judged));
  page.terms(result::terms_of(fields_of(judged)));
  const auto is_of_quantity = [&](const ChangeCause& cause) { return cause.judged == judged.judged; };
  const bool explained =
      std::ranges::any_of(d.causes, is_of_quantity) || std::ranges::any_of(d.partial, is_of_quantity);
  page.figure(residual_figure(judged, explained));
  page.figure(runs_figure(judged, explained));
  page.figure(tried_figure(judged));
  page.table(tried_table(judged));
  if (!judged.not_tested.empty()) page.table(not_tested_table(judged));
}

}  // namespace

Fields fields_of(const JudgedChange& judged) {
  const std::string unit = unit_of(judged.judged, judged.output_unit);
  const Fields loss{{"before", judged.loss_before}, {"left", judged.loss_left}};
  return {
      {"reading", judged.judged == Judged::pressure ? "pressure_kpa" : "displacement_mm"},
      {"unit", unit},
      {"structure", "baseline model", judged.base},
      {"base", judged.base},  // this key is deprecated
      {"noise", "noise of the readings", number(judged.noise_mm, 2, unit)},
      {"healthy_runs", "healthy logs", judged.healthy_runs},
      {"healthy_heldout_rms", "error of left-out healthy runs", number(judged.healthy_mm, 3, unit)},
      {"allowed_rms", "largest error expected for a further healthy run", number(judged.allowed_mm, 3, unit)},
      {"input_factor", "increase of the permitted mean square error by an unfamiliar input",
       number(judged.input_factor, 3)},
      {"unevaluated_share", "share of the readings that are not evaluated",
       number(judged.unevaluated_share, 2)},
      {"later_rms", "error of the later logs", number(judged.later_mm, 3, unit)},
      {"explained_rms", "error with the causes", number(judged.explained_mm, 3, unit)},
      {"explained_percent", "share of the excess error that the causes explain [%]",
       decimals(100 * share_explained(judged), 0)},
      {"whitened_loss", loss},
      {"misfit", loss},
      {"unexplained", judged.left_over},
      {"unusual_log", judged.unusual_log},
      {"interval_contains", "the 95 % intervals contain", judged.interval_contains},
      {"structure_left", judged.left_over},
      {"zero", "change of the zero offset", number(judged.zero_mm, 2, unit)},
      {"gain_percent", "gain change within the spread of healthy runs", number(judged.gain_percent, 2, "%")},
      {"not_tested", result::keyed(judged.not_tested)},
      {"runs", list_of(judged.runs, fields_of_run)},
      {"tried", list_of(judged.tried, fields_of_tried)}};
}

Fields fields_of(const ChangeDiagnosis& d) {
  const JudgedChange& finger = d.readings.back();
  const double gain = finger.later_mm > 0 ? 100 * (1 - finger.explained_mm / finger.later_mm) : 0;
  const double excess = finger.loss_before - 1;
  return {{"schema", 1},
          {"question", "change"},
          {"verdict", name_of(d.verdict)},
          {"output_unit", model::name_of(d.output_unit)},
          {"orientation", Fields{{"pressure", d.orientation.pressure}, {"reading", d.orientation.reading}}},
          {"causes", list_of(d.causes, fields_of_cause)},
          {"alternatives", list_of(d.causes, &ChangeCause::alternatives)},
          {"noise_mm", finger.noise_mm},
          {"heldout_rmse_mm", Fields{{"as_given", finger.later_mm},
                                     {"recalibrated", finger.later_mm},
                                     {"extended", finger.explained_mm}}},
          {"error_reduction_percent", Fields{{"value", gain}, {"ci95", Value()}}},
          {"gain_percent", Fields{{"value", gain}, {"ci95", Value()}}},  // this key is deprecated
          {"unexplained_percent",
           excess > 0 ? std::clamp(100 * (finger.loss_left - 1) / excess, 0.0, 100.0) : 0.0},
          {"partial_causes", list_of(d.partial, fields_of_cause)},
          {"structure", finger.base},
          {"base", finger.base},  // this key is deprecated
          {"next_experiment", Value()},
          {"readings", list_of(d.readings)},
          {"warnings", d.warnings},
          {"wall_s", d.wall_s}};
}

Table cause_table(const ChangeDiagnosis& d) {
  return result::table_of("Causes, largest first", d.causes, fields_of_cause);
}

Table tried_table(const JudgedChange& judged) {
  return result::table_of(
      "Tested causes, each alone; error reduction: reduction of the whitened squared error per bin",
      judged.tried, fields_of_tried);
}

Table run_table(const JudgedChange& judged) {
  return result::table_of(std::string("RMS error of each run after the subtraction of its mean error [") +
                              unit_of(judged.judged, judged.output_unit) + "]",
                          judged.runs, fields_of_run);
}

Table not_tested_table(const JudgedChange& judged) {
  return result::table_of("Not tested", judged.not_tested, [](const auto& entry) -> Fields {
    return {{"", "cause", entry.first}, {"", "recording that would test the cause", entry.second}};
  });
}

std::string name_with_state(const RunLeft& run) {
  return run.run + (run.is_healthy ? " (healthy)" : "");
}

std::string size_text(const ChangeCause& cause) {
  return cause.size.what + " " + significant(cause.size.value, 3) + " " +
         model::in_unit(cause.size.unit, cause.output_unit);
}

std::string interval_text(const ChangeCause& cause) {
  return cause.intervals.size ? text_of(*cause.intervals.size, cause.size.value, " .. ") : "-";
}

std::string change_sentence(const ChangeDiagnosis& diagnosis) {
  return verdict_sentence(diagnosis) + partial_sentences(diagnosis);
}

Page change_page(const ChangeDiagnosis& diagnosis, const std::vector<Log>& healthy,
                 const std::vector<Log>& later, const model::Model& given) {
  Page page("Change since the baseline", change_sentence(diagnosis), tone_of(diagnosis.verdict));
  std::vector<Log> all = healthy;
  for (Log& log : all) log.name += " (healthy)";
  all.insert(all.end(), later.begin(), later.end());
  page.provenance(provenance_of(all, {{"given", &given}}));
  if (!diagnosis.causes.empty()) add_causes(page, diagnosis);
  if (!diagnosis.partial.empty())
    page.table(result::table_of("Partial explanations, too small to be reported as the cause",
                                diagnosis.partial, fields_of_cause));
  if (!diagnosis.warnings.empty()) {
    page.section("Limits of the data");
    page.list(diagnosis.warnings);
  }
  for (const JudgedChange& judged : diagnosis.readings) add_reading(page, judged, diagnosis);
  return page;
}

}  // namespace softgrip::sysid
