// Creates the page of the study of the published model.

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "bench/studies/models.h"
#include "bench/studies/published.h"

namespace softgrip::studies {
namespace {

using sysid::Chart;
using sysid::Colour;
using sysid::Series;

Series line(std::string label, std::vector<double> x, std::vector<double> y, Colour colour,
            bool dashed = false) {
  Series series;
  series.label = std::move(label);
  series.x = std::move(x);
  series.y = std::move(y);
  series.colour = colour;
  series.dash = dashed ? sysid::Dash::dashed : sysid::Dash::solid;
  return series;
}

std::string verdict(const PublishedStudy& study) {
  double largest = 0;
  for (const HiddenLatency& row : study.latency) largest = std::max(largest, row.ratio);
  double worst = 0;
  for (const PublishedMatch& row : study.matches) worst = std::max(worst, row.rmse_mm);
  return "An unmodelled latency makes the published structure appear non-invertible: an ordinary "
         "actuator is identified with beta/(alpha + 1/k0) of up to " +
         ratio_text(largest) +
         ", and an invertible actuator behind lag and delay reproduces the published response with an RMSE "
         "of at most " +
         fixed(worst, 3) + " mm.";
}

Chart ratio_chart(const PublishedStudy& study) {
  Chart chart;
  chart.x.label = "hidden lag + delay [s]";
  chart.y.label = "beta/(alpha + 1/k0) as fitted";
  chart.y.logarithmic = true;
  chart.y.lower = 0.4;
  chart.y.upper = 40;
  std::vector<double> latency, ratio, other;
  for (const HiddenLatency& row : study.latency) {
    latency.push_back(row.lag_s + row.delay_s);
    ratio.push_back(row.ratio);
    other.push_back(row.other_ratio);
  }
  chart.series.push_back(line("six mixed triangles", latency, ratio, Colour::model));
  chart.series.push_back(line("three rising triangles", latency, other, Colour::other));
  chart.marks.push_back({sysid::Mark::Direction::horizontal, 1, "inverse response above this line"});
  chart.marks.push_back({sysid::Mark::Direction::horizontal, study.published_ratio, "published"});
  return chart;
}

/// Returns two charts in one column: the log with the fitted response, and the residual.
sysid::ChartRows fit_charts(const sysid::Log& log, const std::vector<double>& answer_mm,
                            const std::string& given, const std::string& answering) {
  Chart overlay;
  overlay.y.label = "displacement [mm]";
  overlay.series.push_back(line(given, log.time_s, log.displacement_mm, Colour::measured));
  overlay.series.push_back(line(answering, log.time_s, answer_mm, Colour::model, true));
  Chart error;
  error.x.label = "time [s]";
  error.y.label = "difference [mm]";
  error.height = 160;
  std::vector<double> difference(log.size());
  for (std::size_t i = 0; i < log.size(); ++i) difference[i] = log.displacement_mm[i] - answer_mm[i];
  error.series.push_back(line("", log.time_s, difference, Colour::error));
  return {{overlay}, {error}};
}

void latency_section(sysid::Page& page, const PublishedStudy& study) {
  page.section("1. A latency that hysteresis absorbs");
  page.paragraph(
      "An ordinary, invertible actuator behind a valve lag and a dead time is driven by triangles of 0.2 to "
      "0.6 bar at 0.1 to 0.4 Hz. The noise of its readings is " +
      significant(study.options.noise_mm) +
      " mm. The published structure, which has no lag and no dead time, is fitted to the readings. If the "
      "fitted ratio "
      "is 1 or more, the fitted model has an inverse response and no causal inverse.");
  page.table(result::table_of("Ratio: beta/(alpha + 1/k0). Published: ratio " +
                                  fixed(study.published_ratio, 2) +
                                  ", tau2 0.60 s, k2 0.020 bar/mm, c2 0.012 bar s/mm. True values of the "
                                  "simulated actuator: k2 0.04 bar/mm, c2 0.016 bar s/mm, tau2 0.4 s.",
                              study.latency));
  page.figure({"fitted ratio by hidden latency",
               "Fitted ratio beta/(alpha + 1/k0) over the hidden latency.",
               {{ratio_chart(study)}}});
  page.paragraph(
      "The ratio depends on the choice of triangles: two choices within one range of amplitude and frequency "
      "give different ratios. For large "
      "ratios, the denominator alpha + 1/k0 approaches zero.");
  if (study.latency_log.size() > 0) {
    page.figure(
        {"fit to the longest latency",
         "The longest latency: the structure without a valve fits this response closely, so a small error is "
         "no evidence that the actuator has this structure.",
         fit_charts(study.latency_log, study.latency_mm, "actuator behind the valve", "fitted model")});
  }
}

void match_section(sysid::Page& page, const PublishedStudy& study) {
  page.section("2. The published response from an ordinary actuator");
  page.paragraph(
      "The response of the published model to tp1, for several values of the unpublished parameter eta, is "
      "matched "
      "by an actuator with beta at most 0.8 (alpha + 1/k0) behind lag and delay. The residual that the paper "
      "reports on its signal TP1 is 0.194 mm.");
  page.table(result::table_of("", study.matches));
  if (study.match_log.size() > 0) {
    page.figure(
        {"published response from an invertible actuator",
         "The first row of the table, on the signal to which the actuator was fitted.",
         fit_charts(study.match_log, study.match_mm, "published model", "invertible actuator + valve")});
  }
  page.paragraph(
      "The model of the simulated rig (bench_twin) is such an actuator. The RMSE of this model against the "
      "published response to tp1 for eta = 2 /bar is " +
      fixed(study.twin_rmse_mm, 4) + " mm. All parameters except k0 were fitted.");
}

void inverse_section(sysid::Page& page, const PublishedStudy& study) {
  page.section("3. Consequences for an inverse");
  page.paragraph(
      "The published Bouc-Wen element with a varied beta is driven by a sine of 0 to 60 kPa. Each inverse "
      "computes the pressure from the resulting displacement. The explicit form p(k) = (y(k) + "
      "h(k-1))/alpha is a fixed-point iteration whose loop gain is beta/alpha. The displacement is y = alpha "
      "p - h, where h is its hysteretic part.");
  page.table(result::table_of("", study.inverses));
  std::vector<Chart> charts;
  for (const InverseTrial& row : study.inverses) {
    if (row.ratio != 0.95 && row.ratio != 1.25 && row.ratio < 2) continue;
    Chart chart;
    chart.title = "beta/alpha = " + significant(row.ratio, 3);
    chart.x.label = "time [s]";
    chart.y.label = "pressure [kPa]";
    chart.series.push_back(line("explicit", study.inverse_time_s, row.explicit_kpa, Colour::bad));
    chart.series.push_back(line("implicit", study.inverse_time_s, row.implicit_kpa, Colour::model));
    chart.series.push_back(
        line("to be found", study.inverse_time_s, study.inverse_true_kpa, Colour::measured, true));
    charts.push_back(std::move(chart));
  }
  page.figure({"inverses",
               "If beta/alpha is below 1, both forms find the pressure. The error of the explicit form grows "
               "as beta/alpha approaches 1. If beta/alpha is above 1, no inverse exists.",
               sysid::stacked(std::move(charts))});
  page.list(
      {"Existence: the element alone has an inverse up to beta = alpha. The published element has beta/alpha "
       "2.43; during the first loading, its output falls by " +
           fixed(study.falls_by_mm, 2) + " mm until " + fixed(study.falls_until_kpa, 1) + " kPa" +
           (std::isfinite(study.back_at_kpa)
                ? " and returns to its initial value only at " + fixed(study.back_at_kpa, 1) + " kPa."
                : " and does not return to its initial value below 60 kPa."),
       "Explicit form: if beta/alpha exceeds 1, each sample multiplies the error of the pressure by "
       "beta/alpha until the bounded hysteresis state stops this growth. The computed pressure then "
       "oscillates by tens of kPa.",
       "Implicit form: up to beta = alpha, the computed pressure is correct except for rounding errors. "
       "Above this limit, "
       "several pressures or no pressure fit the displacement. The implicit form then selects one pressure, "
       "jumps, or stays at a bound of 0 to 60 kPa and reports this.",
       "Controller: before a start, the controller checks the model. Result for bouc_wen of the published "
       "model: " +
           study.bouc_wen_refusal + ". full_model: " + study.full_model_refusal + "."});
}

void paper_section(sysid::Page& page, const PublishedStudy& study) {
  page.section("4. The four RMSE values of the paper");
  page.paragraph(
      "Section 4 of the paper: its structure, identified on TP1, predicts TP2, SP1 and SP2. This study "
      "repeats the procedure with simulated logs of two fingers, noise " +
      significant(study.options.noise_mm) + " mm.");
  page.table(result::table_of(
      "RMSE in mm; in brackets: share of the span of the log [%], which the paper does not give.",
      study.paper));
  page.list(paper_table_remarks());
}

}  // namespace

sysid::Page published_page(const PublishedStudy& study) {
  sysid::Page page("Study of the published model", verdict(study), sysid::Tone::doubtful);
  page.provenance({{"Software", sysid::software_and_version()},
                   {"Command", "softgrip study published --seed " + std::to_string(study.options.seed)},
                   {"Logs", significant(study.options.rate_hz) + " Hz, noise " +
                                significant(study.options.noise_mm) + " mm"},
                   {"Searches", std::to_string(study.options.starts) + " per identification"},
                   {"Time", significant(study.wall_s, 3) + " s"}});
  page.paragraph(
      "These results are facts about the structure, but only a hypothesis about the paper, whose data are "
      "not public. "
      "Zhang, "
      "Lu, "
      "Huang, Feng, Actuators 2025, 14(4), 193; the pressures of the paper are assumed to be in bar.");
  latency_section(page, study);
  match_section(page, study);
  inverse_section(page, study);
  paper_section(page, study);
  return page;
}

}  // namespace softgrip::studies
