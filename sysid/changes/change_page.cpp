#include "sysid/changes/change_page.h"

#include <limits>

#include "base/enumerated.h"
#include "base/numbers.h"
#include "sysid/changes/next_steps.h"
#include "sysid/pages/provenance.h"

namespace softgrip::sysid {
namespace {

/// Largest number of tested causes that the figure shows.
constexpr std::size_t drawn_causes = 8;

Tone tone_of(ChangeVerdict verdict) {
  if (verdict == ChangeVerdict::unchanged) return Tone::good;
  return verdict == ChangeVerdict::cause_found ? Tone::bad : Tone::doubtful;
}

void add_causes(Page& page, const ChangeDiagnosis& d) {
  page.section("What changed");
  Table table{
      "Causes, largest first",
      {"cause", "size", "95 % interval", "at full pressure", "share of the error [%]", "alternatives"},
      {false, false, false, false, true, false},
      {}};
  for (const ChangeCause& cause : d.causes) {
    table.rows.push_back(
        {cause.id, size_text(cause), interval_text(cause),
         significant(cause.full_pressure_mm, 2) + " " + unit_of(cause.judged, cause.output_unit),
         fixed(cause.share_percent, 0), cause.alternatives.empty() ? "-" : with_commas(cause.alternatives)});
  }
  page.table(table);
  for (const ChangeCause& cause : d.causes) {
    page.subsection("Next steps for " + cause.id);
    const auto steps = next_steps(cause.id);
    page.list({std::string(steps[0]), std::string(steps[1])});
  }
}

/// Returns the figure of the residuals in the later logs, without and with the causes. The logs follow each
/// other on the time axis.
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
      before.x.push_back((static_cast<double>(b) + 0.5) * judged.bin_s);
      before.y.push_back(judged.left[r][b]);
    }
    Series after;
    after.label = "with the causes";
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
  chart.y.label = "improvement";
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

std::string name_with_state(const RunLeft& run) {
  return run.run + (run.is_healthy ? " (healthy)" : "");
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
    chart.series.push_back(points_over_names("with the causes", Colour::model, std::move(after)));
  return {std::string("error by run ") + name_of(judged.judged),
          "RMS error of the baseline model in each run, after the mean error of the run is subtracted. To "
          "predict a healthy run, the model is fitted to the other healthy runs.",
          stacked({chart})};
}

/// Returns the table of the causes that the logs cannot show, with a recording that would test each cause.
Table not_tested_table(const JudgedChange& judged) {
  Table table{"Not tested", {"cause", "recording that would test the cause"}, {false, false}, {}};
  for (const auto& [id, recording] : judged.not_tested) table.rows.push_back({id, recording});
  return table;
}

void add_reading(Page& page, const JudgedChange& judged, const ChangeDiagnosis& d) {
  page.section(std::string("The ") + name_of(judged.judged));
  const std::string unit = std::string(" ") + unit_of(judged.judged, judged.output_unit);
  page.terms({{"base", judged.base},
              {"noise of the readings", significant(judged.noise_mm, 2) + unit},
              {"healthy logs", std::to_string(judged.healthy_runs)},
              {"error of left-out healthy runs", significant(judged.healthy_mm, 3) + unit},
              {"largest error that another healthy run may have", significant(judged.allowed_mm, 3) + unit},
              {"error of the later logs", significant(judged.later_mm, 3) + unit},
              {"with the causes", significant(judged.explained_mm, 3) + unit},
              {"offset change", significant(judged.zero_mm, 2) + unit},
              {"gain within the healthy spread", significant(judged.gain_percent, 2) + " %"}});
  bool explained = false;
  for (const ChangeCause& cause : d.causes) explained |= cause.judged == judged.judged;
  page.figure(residual_figure(judged, explained));
  page.figure(runs_figure(judged, explained));
  page.figure(tried_figure(judged));
  page.table(tried_table(judged));
  if (!judged.not_tested.empty()) page.table(not_tested_table(judged));
}

}  // namespace

Page change_page(const ChangeDiagnosis& diagnosis, const std::vector<Log>& healthy,
                 const std::vector<Log>& later, const model::Model& given) {
  Page page("Change since the baseline", change_sentence(diagnosis), tone_of(diagnosis.verdict));
  std::vector<Log> all = healthy;
  for (Log& log : all) log.name += " (healthy)";
  all.insert(all.end(), later.begin(), later.end());
  page.provenance(provenance_of(all, {{"given", &given}}));
  if (!diagnosis.causes.empty()) add_causes(page, diagnosis);
  if (!diagnosis.warnings.empty()) {
    page.section("Limits of the data");
    page.list(diagnosis.warnings);
  }
  for (const JudgedChange& judged : diagnosis.readings) add_reading(page, judged, diagnosis);
  return page;
}

Table tried_table(const JudgedChange& judged) {
  Table table{"Tested causes, each alone; improvement: reduction of the whitened squared error per bin",
              {"cause", "improvement", "in healthy runs", "tolerance", "reason of rejection"},
              {false, true, true, true, false},
              {}};
  for (const TriedCause& tried : judged.tried)
    table.rows.push_back({tried.id, fixed(tried.gain, 3), fixed(tried.healthy_gain, 3),
                          fixed(tried.tolerance, 3), tried.rejected});
  return table;
}

Table run_table(const JudgedChange& judged) {
  Table table{std::string("RMS error of each run after the subtraction of its mean error [") +
                  unit_of(judged.judged, judged.output_unit) + "]",
              {"run", "base", "with the causes"},
              {false, true, true},
              {}};
  for (const RunLeft& run : judged.runs)
    table.rows.push_back({name_with_state(run), significant(run.base, 3),
                          run.is_healthy ? "-" : significant(run.explained, 3)});
  return table;
}

}  // namespace softgrip::sysid
