#include "sysid/diagnosis/report/report_sections.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "base/numbers.h"

namespace softgrip::sysid {
namespace {

std::string title_of(const GaugeFit& fit) {
  return fit.shape.blocks.empty() ? "linear sensor" : fit.shape.id() + " as fitted to the logs";
}

Colour colour_of(std::size_t hypothesis) {
  constexpr Colour colours[]{Colour::model, Colour::error, Colour::other, Colour::faint};
  return colours[std::min<std::size_t>(hypothesis, 3)];
}

Table hypotheses_table(const GaugeEvidence& gauge) {
  const auto of_fit = [&](const GaugeFit& fit) { return hypothesis_fields(fit, gauge.file.output_unit); };
  Table table = result::table_of("", gauge.check.fits, of_fit);
  table.header.back().clear();  // the sentences in the last column need no title
  return table;
}

}  // namespace

result::Fields hypothesis_fields(const GaugeFit& fit, model::OutputUnit unit) {
  return {{"id", "hypothesis", result::shown(fit.shape.id(), title_of(fit))},
          {"rms_mm", model::in_unit("residual [mm]", unit), result::number(fit.rms_mm, 3)},
          {"tolerance_mm", fit.tolerance_mm},
          {"explains", fit.explains},
          {"behind", "log likelihood ratio to the best hypothesis", result::number(fit.behind, 3)},
          {"ruled_out", fit.ruled_out},
          {"zero_mm", fit.zero_mm},
          {"scale", fit.scale},
          {"", "result",
           fit.ruled_out  ? "ruled out"
           : fit.explains ? "explains the readings"
                          : "does not explain the gauge readings"}};
}

Chart gauge_chart(const GaugeEvidence& gauge) {
  const GaugeCheck& check = gauge.check;
  const std::vector<GaugeReading>& readings = gauge.file.readings;
  std::vector<std::size_t> order(readings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return readings[a].position_mm < readings[b].position_mm;
  });
  const auto beside = [&](const std::vector<double>& values_mm) {
    Series series;
    for (const std::size_t i : order) {
      series.x.push_back(readings[i].position_mm);
      series.y.push_back(values_mm[i] - check.straight.predicted_mm[i]);
    }
    return series;
  };
  Chart chart;
  chart.x.label = model::in_unit("position on the gauge [mm]", gauge.file.output_unit);
  chart.y.label = model::in_unit("reading minus best straight line [mm]", gauge.file.output_unit);
  for (std::size_t h = 0; h < check.fits.size(); ++h) {
    Series curve = beside(check.fits[h].predicted_mm);
    curve.label = title_of(check.fits[h]);
    curve.colour = colour_of(h);
    curve.dash = check.fits[h].ruled_out ? Dash::dashed : Dash::solid;
    chart.series.push_back(std::move(curve));
  }
  Series points = beside(check.cut_mm);
  points.label = "gauge readings";
  points.style = Series::Style::points;
  points.width = 2.5;
  chart.series.push_back(std::move(points));
  return chart;
}

void add_gauge_section(Page& page, const GaugeEvidence& gauge) {
  const GaugeCheck& check = gauge.check;
  page.section("Gauge check of the sensor");
  page.paragraph(gauge.sentence);
  page.figure({"gauge check of the sensor",
               "Readings of the sensor at known positions (" + gauge.file.path +
                   "), relative to the straight line that fits best. Dashed: hypotheses that are ruled out. "
                   "Readings outside the slightly widened range of the logs are clipped to this range.",
               {{gauge_chart(gauge)}}});
  page.table(hypotheses_table(gauge));
  page.paragraph(
      "Zero and scale of every hypothesis are fitted to the readings. Noise of a reading: " +
      significant(check.noise_mm, 2) + " " + std::string(name_of(gauge.file.output_unit)) +
      " (standard deviation of repeated readings at one position: " + significant(check.repeat_noise_mm, 2) +
      "). In the comparison of two hypotheses, an error of 20 % of the difference between the "
      "hypotheses is tolerated in addition to the noise. A hypothesis is ruled out if the most "
      "likely hypothesis explains the readings and is at least 1000 times as likely as this "
      "hypothesis (a difference of " +
      significant(gauge_log_likelihood_needed, 2) + " in log likelihood).");
}

}  // namespace softgrip::sysid
