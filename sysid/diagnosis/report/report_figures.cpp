#include "sysid/diagnosis/report/report_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/numbers.h"
#include "sysid/fitting/trajectory.h"

namespace softgrip::sysid {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// One of the models that a diagnosis compares.
struct Shown {
  const char* label;
  Colour colour;
  const StructureFit* fit;
};

std::vector<Shown> shown(const Diagnosis& d) {
  std::vector<Shown> list{{"as given", Colour::error, &d.as_given},
                          {"recalibrated", Colour::model, &d.recalibrated}};
  if (is_extended(d)) list.push_back({"extended", Colour::good, &d.extended});
  return list;
}

Series curve(const char* label, Colour colour, double width, const std::vector<double>& x,
             const std::vector<double>& y) {
  Series series;
  series.label = label;
  series.colour = colour;
  series.width = width;
  series.x = x;
  series.y = y;
  return series;
}

std::vector<double> prediction(const StructureFit& fit, const Record& record, std::size_t k) {
  return predict(fit.point.model, record, fit.point.starts[k]);
}

/// The bins of one group as points with whiskers.
void add_bins(Chart& chart, const ConditionEvidence& e, std::size_t group, const std::string& label,
              Colour colour, bool whiskers) {
  Series means, intervals;
  means.label = label;
  means.colour = intervals.colour = colour;
  means.style = e.condition.categories.empty() ? Series::Style::line : Series::Style::points;
  means.width = e.condition.categories.empty() ? 1.4 : 3.5;
  means.dashed = !whiskers;
  intervals.width = 1.2;
  for (const ConditionBin& bin : e.bins) {
    if (bin.group != group) continue;
    means.x.push_back(bin.value);
    means.y.push_back(bin.mean_mm);
    intervals.x.insert(intervals.x.end(), {bin.value, bin.value, none});
    intervals.y.insert(intervals.y.end(), {bin.lower_mm, bin.upper_mm, none});
  }
  if (whiskers && e.condition.categories.empty()) {
    Series dots = means;
    dots.label.clear();
    dots.style = Series::Style::points;
    dots.width = 2.5;
    chart.series.push_back(dots);
  }
  if (whiskers) chart.series.push_back(intervals);
  chart.series.push_back(means);
}

}  // namespace

std::vector<Chart> diagnosis_overlay(const Diagnosis& d, std::size_t k) {
  const Record& record = d.records[k];
  Chart values, errors;
  values.title = record.name;
  values.y.label = "displacement [mm]";
  values.height = 260;
  values.series.push_back(curve("measured", Colour::measured, 2.4, record.time_s, record.reading_mm));
  errors.y.label = "error [mm]";
  errors.x.label = "time [s]";
  errors.height = 200;
  for (const Shown& model : shown(d)) {
    values.series.push_back(
        curve(model.label, model.colour, 1, record.time_s, prediction(*model.fit, record, k)));
    errors.series.push_back(curve("", model.colour, 1, record.time_s, model.fit->residual_mm[k]));
  }
  return {values, errors};
}

Chart diagnosis_loops(const Diagnosis& d, std::size_t k) {
  const Record& record = d.records[k];
  Chart chart;
  chart.width = 380;
  chart.height = 300;
  chart.x.label = "pressure [kPa]";
  chart.y.label = "displacement [mm]";
  chart.series.push_back(curve("measured", Colour::measured, 2.2, record.drive_kpa, record.reading_mm));
  for (const Shown& model : shown(d)) {
    if (model.fit == &d.as_given) continue;
    chart.series.push_back(
        curve(model.label, model.colour, 1, record.drive_kpa, prediction(*model.fit, record, k)));
  }
  return chart;
}

Chart errors_by_pressure(const Diagnosis& d, std::size_t k) {
  const Record& record = d.records[k];
  Chart chart;
  chart.width = 380;
  chart.height = 300;
  chart.x.label = "pressure [kPa]";
  chart.y.label = "error [mm]";
  for (const Shown& model : shown(d)) {
    if (model.fit == &d.as_given) continue;
    Series series = curve(model.label, model.colour, 0.7, record.drive_kpa, model.fit->residual_mm[k]);
    series.style = Series::Style::points;
    chart.series.push_back(series);
  }
  return chart;
}

Chart condition_chart(const ConditionEvidence& recalibrated, const ConditionEvidence* extended) {
  const Condition& condition = recalibrated.condition;
  Chart chart;
  chart.width = 380;
  chart.height = 250;
  chart.title = condition.id;
  std::replace(chart.title.begin(), chart.title.end(), '_', ' ');
  chart.x.label = condition.axis;
  chart.x.logarithmic = condition.logarithmic;
  chart.x.categories = condition.categories;
  if (!condition.categories.empty()) {
    std::size_t used = 0;
    for (const ConditionBin& bin : recalibrated.bins)
      used = std::max(used, static_cast<std::size_t>(bin.value) + 1);
    chart.x.categories.resize(used);
    chart.x.lower = -0.5;
    chart.x.upper = static_cast<double>(used) - 0.5;
  }
  chart.y.label = "mean error [mm]";
  const std::size_t groups = std::max<std::size_t>(1, condition.groups.size());
  if (extended != nullptr && extended->condition.why_not.empty()) {
    for (std::size_t g = 0; g < groups; ++g)
      add_bins(chart, *extended, g, g == 0 ? "extended" : "", Colour::good, false);
  }
  for (std::size_t g = 0; g < groups; ++g) {
    const std::string label = condition.groups.empty() ? "recalibrated" : condition.groups[g];
    add_bins(chart, recalibrated, g, label, g == 0 ? Colour::model : Colour::error, true);
  }
  return chart;
}

Chart spectrum_chart(const Diagnosis& d) {
  Chart chart;
  chart.height = 260;
  chart.x.label = "frequency [Hz]";
  chart.y.label = "error [mm\xc2\xb2/Hz]";
  chart.x.logarithmic = true;
  chart.y.logarithmic = true;
  const auto add = [&](const char* label, Colour colour, const ResidualEvidence& e) {
    chart.series.push_back(curve(label, colour, 1.4, e.spectrum.frequency_hz, e.spectrum.density_mm2_per_hz));
  };
  add("as given", Colour::error, d.evidence->as_given);
  add("recalibrated", Colour::model, d.evidence->recalibrated);
  if (is_extended(d)) add("extended", Colour::good, d.evidence->extended);
  const SpectrumEvidence& s = d.evidence->recalibrated.spectrum;
  if (!s.frequency_hz.empty()) {
    // White noise of this deviation, up to half the sampling rate.
    const double density = d.noise_mm * d.noise_mm / s.frequency_hz.back();
    chart.marks.push_back({Mark::Direction::horizontal, density, "noise of the readings"});
  }
  return chart;
}

Chart gain_chart(const Diagnosis& d) {
  Chart chart;
  chart.width = 440;
  chart.height = 220;
  chart.y.label = "held-out RMSE [mm]";
  chart.x.categories = {"as given", "recalibrated"};
  Series bars;
  bars.style = Series::Style::bars;
  bars.colour = Colour::model;
  bars.x = {0, 1};
  bars.y = {d.as_given_rmse_mm, d.recalibrated_rmse_mm};
  if (is_extended(d)) {
    chart.x.categories.emplace_back("extended");
    bars.x.push_back(2);
    bars.y.push_back(d.extended_rmse_mm);
  }
  chart.x.lower = -0.6;
  chart.x.upper = static_cast<double>(bars.x.size()) - 0.4;
  chart.series = {bars};
  chart.marks.push_back({Mark::Direction::horizontal, d.noise_mm, "noise"});
  return chart;
}

}  // namespace softgrip::sysid
