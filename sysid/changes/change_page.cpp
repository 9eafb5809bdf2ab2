#include "sysid/changes/change_page.h"

#include <algorithm>
#include <limits>

#include "base/numbers.h"
#include "sysid/changes/change_result.h"
#include "sysid/changes/next_steps.h"
#include "sysid/pages/page.h"

namespace softgrip::sysid {
namespace {

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
      before.x.push_back((static_cast<double>(b) + 0.5) * judged.bin_s);
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
  const bool explained = std::any_of(d.causes.begin(), d.causes.end(),
                                     [&](const ChangeCause& cause) { return cause.judged == judged.judged; });
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

}  // namespace softgrip::sysid
