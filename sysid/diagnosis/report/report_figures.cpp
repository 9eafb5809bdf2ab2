#include "sysid/diagnosis/report/report_sections.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "base/numbers.h"
#include "sysid/diagnosis/evidence/evidence.h"
#include "sysid/fitting/trajectory.h"

namespace softgrip::sysid {
namespace {

/// A model whose curves the figures show, with its label and line style.
struct Shown {
  const char* label;
  Colour colour;
  Dash dash;
  const StructureFit* fit;
};

std::vector<Shown> shown(const Diagnosis& d) {
  std::vector<Shown> list{{"given model", Colour::error, Dash::dotted, &d.as_given},
                          {"recalibrated model", Colour::model, Dash::dashed, &d.recalibrated}};
  if (is_extended(d)) list.push_back({"extended model", Colour::good, Dash::solid, &d.extended});
  return list;
}

/// Returns the fit of the final model of a diagnosis. This is the extended model. If the diagnosis has no
/// extended model, it is the refitted model.
const StructureFit& final_fit(const Diagnosis& d) {
  return is_extended(d) ? d.extended : d.recalibrated;
}
/// Returns the fit with which the figures compare the final model. If the diagnosis extended the model, this
/// is the refitted model; otherwise it is the given model.
const StructureFit& first_fit(const Diagnosis& d) {
  return is_extended(d) ? d.recalibrated : d.as_given;
}

double mean_square(const std::vector<double>& residual_mm) {
  double sum = 0, count = 0;
  for (const double r : residual_mm) {
    if (std::isnan(r)) continue;
    sum += r * r;
    count += 1;
  }
  return count > 0 ? sum / count : 0;
}

Series curve(std::string label, Colour colour, double width, const std::vector<double>& x,
             const std::vector<double>& y) {
  Series series;
  series.label = std::move(label);
  series.colour = colour;
  series.width = width;
  series.x = x;
  series.y = y;
  return series;
}

Series curve_of(const Shown& model, const std::vector<double>& x, const std::vector<double>& y) {
  Series series = curve(model.label, model.colour, 1.1, x, y);
  series.dash = model.dash;
  return series;
}

/// A rectangular section of a chart with pressure and displacement as axes.
struct Window {
  double lower_kpa, upper_kpa, lower_mm, upper_mm;

  [[nodiscard]] bool holds(double kpa, double mm) const {
    return kpa >= lower_kpa && kpa <= upper_kpa && mm >= lower_mm && mm <= upper_mm;
  }
};

std::vector<double> prediction(const StructureFit& fit, const Record& record, std::size_t k) {
  return predict(fit.point.model, record, fit.point.starts[k]);
}

/// Returns a window around the sample with the largest difference between the predictions `first` and
/// `final`. The window covers 10 % of the pressure range. Its height is at least 2.4 times the largest
/// difference.
Window window_of(const Record& record, const std::vector<double>& first, const std::vector<double>& final) {
  std::size_t at = 0;
  double most = 0;
  for (std::size_t i = 0; i < record.size(); ++i) {
    const double difference = std::abs(first[i] - final[i]);
    if (!(difference > most)) continue;
    most = difference;
    at = i;
  }
  const auto [low, high] = std::minmax_element(record.drive_kpa.begin(), record.drive_kpa.end());
  const double half_kpa = std::max(1e-6, (*high - *low) / 20);
  const double half_mm = std::max({1.2 * most, 0.03 * record.span_mm, 1e-6});
  const double mm = 0.5 * (first[at] + final[at]);
  const double kpa =
      std::clamp(record.drive_kpa[at], *low + half_kpa, std::max(*low + half_kpa, *high - half_kpa));
  return {kpa - half_kpa, kpa + half_kpa, mm - half_mm, mm + half_mm};
}

/// Returns the lowest and the highest value of the curves in a chart. A margin of 4 % of the range is
/// subtracted and added.
std::pair<double, double> reach_of(const Chart& chart) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const Series& series : chart.series) {
    for (const double y : series.y) {
      if (!std::isfinite(y)) continue;
      lowest = std::min(lowest, y);
      highest = std::max(highest, y);
    }
  }
  if (!(lowest < highest)) return {-1, 1};
  const double margin = 0.04 * (highest - lowest);
  return {lowest - margin, highest + margin};
}

/// Returns the part of a curve within the window. A point outside the window is replaced by a gap.
Series within(Series series, const Window& window) {
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    if (!window.holds(series.x[i], series.y[i])) series.y[i] = std::numeric_limits<double>::quiet_NaN();
  }
  return series;
}

}  // namespace

std::vector<std::size_t> logs_by_gain(const Diagnosis& d) {
  std::vector<std::size_t> order(d.records.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto gain = [&](std::size_t k) {
    return mean_square(first_fit(d).residual_mm[k]) - mean_square(final_fit(d).residual_mm[k]);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return gain(a) > gain(b); });
  return order;
}

bool has_loops(const Record& record) {
  constexpr double least_share = 0.1, slowest_per_s = 0.01;
  double moving_s = 0;
  for (std::size_t i = 1; i < record.size(); ++i) {
    const double interval_s = record.time_s[i] - record.time_s[i - 1];
    const double change_kpa = std::abs(record.drive_kpa[i] - record.drive_kpa[i - 1]);
    if (change_kpa > slowest_per_s * record.largest_kpa * interval_s) moving_s += interval_s;
  }
  return moving_s >= least_share * record.length_s();
}

std::optional<std::size_t> first_with_loops(const Diagnosis& d) {
  for (const std::size_t k : logs_by_gain(d)) {
    if (has_loops(d.records[k])) return k;
  }
  return std::nullopt;
}

Figure error_figure(const Diagnosis& d, std::size_t k) {
  const Record& record = d.records[k];
  // Ratio of the errors of the given and the refitted model above which the given model is not drawn. Its
  // curve would compress the scale for the other curves.
  constexpr double far_off = 4;
  const bool given_far_off = std::sqrt(mean_square(d.as_given.residual_mm[k])) >
                             far_off * std::sqrt(mean_square(d.recalibrated.residual_mm[k]));
  Chart values, before, after;
  // The titles of the charts state the quantities. The axis labels therefore contain only the units.
  const std::string unit(model::name_of(record.output_unit));
  values.title = record.name + ": " + model::in_unit("displacement", record.output_unit);
  values.y.label = before.y.label = after.y.label = "[" + unit + "]";
  values.height = 150;
  values.series.push_back(curve("measured", Colour::measured, 2.4, record.time_s, record.reading_mm));
  before.title = is_extended(d) ? "error before" : "error";
  after.title = "error after";
  before.height = after.height = 105;
  std::string numbers;
  for (const Shown& model : shown(d)) {
    const bool left_out = given_far_off && model.fit == &d.as_given;
    if (left_out || model.fit == &final_fit(d))
      values.series.push_back(curve_of(model, record.time_s, prediction(*model.fit, record, k)));
    Chart& errors = model.fit == &d.extended ? after : before;
    if (!left_out) errors.series.push_back(curve_of(model, record.time_s, model.fit->residual_mm[k]));
    numbers += (numbers.empty() ? "" : ", ") + std::string(model.label) + " " +
               significant(std::sqrt(mean_square(model.fit->residual_mm[k])), 3) + " " + unit;
  }
  std::vector<Chart> charts{values, before};
  if (is_extended(d)) {
    const auto [lowest, highest] = reach_of(before);
    after.y.lower = lowest;
    after.y.upper = highest;
    charts[1].y = after.y;
    charts.push_back(after);
  }
  charts.back().x.label = "time [s]";
  charts.back().height = is_extended(d) ? 125 : 170;
  return {
      "error over time " + record.name,
      record.name +
          ": measured and predicted displacement, and the difference between reading and prediction. RMSE: " +
          numbers + "." +
          (given_far_off ? " The error of the given model is not drawn, because this error is too large for "
                           "the scale of the figure."
                         : "") +
          (d.outliers.present ? " Outliers are omitted." : ""),
      stacked(std::move(charts))};
}

Figure runs_figure(const Diagnosis& d) {
  std::vector<std::string> names;
  std::vector<double> given, recalibrated, extended;
  for (const RunError& one : d.runs) {
    names.push_back(one.run);
    given.push_back(one.given);
    recalibrated.push_back(one.recalibrated);
    extended.push_back(one.extended);
  }
  Chart chart = chart_over(std::move(names));
  chart.y.label = model::in_unit("RMSE [mm]", d.extended_model.output_unit);
  chart.y.logarithmic = true;
  const std::vector<Shown> models = shown(d);
  const std::array errors{&given, &recalibrated, &extended};
  for (std::size_t i = 0; i < models.size(); ++i)
    chart.series.push_back(points_over_names(models[i].label, models[i].colour, *errors[i]));
  chart.marks.push_back({Mark::Direction::horizontal, d.noise_mm, "noise of the readings"});
  return {"error by run",
          std::string("RMSE of each ") + (d.records.size() > 1 ? "run" : "half of the run") +
              ". For each value, the recalibrated and the extended model were fitted to the other logs or to "
              "the other half of the log. The given model was not fitted.",
          {{chart}}};
}

Figure loops_figure(const Diagnosis& d, std::size_t k) {
  const Record& record = d.records[k];
  Chart whole;
  whole.width = 380;
  whole.height = 290;
  whole.x.label = "pressure [kPa]";
  whole.y.label = model::in_unit("displacement [mm]", record.output_unit);
  Chart zoom = whole;
  const Window window =
      window_of(record, prediction(first_fit(d), record, k), prediction(final_fit(d), record, k));
  zoom.x.lower = window.lower_kpa;
  zoom.x.upper = window.upper_kpa;
  zoom.y.lower = window.lower_mm;
  zoom.y.upper = window.upper_mm;
  zoom.title = "enlarged: largest difference between the models";
  const Series measured = curve("measured", Colour::measured, 2.2, record.drive_kpa, record.reading_mm);
  whole.series.push_back(measured);
  zoom.series.push_back(within(measured, window));
  zoom.series.back().label.clear();
  zoom.series.back().style = Series::Style::points;
  zoom.series.back().width = 2.2;
  for (const Shown& model : shown(d)) {
    if (model.fit != &first_fit(d) && model.fit != &final_fit(d)) continue;
    const Series modelled = curve_of(model, record.drive_kpa, prediction(*model.fit, record, k));
    whole.series.push_back(modelled);
    zoom.series.push_back(within(modelled, window));
    zoom.series.back().label.clear();
    zoom.series.back().width = 1.3;
  }
  whole.series.push_back(
      curve("", Colour::text, 1,
            {window.lower_kpa, window.upper_kpa, window.upper_kpa, window.lower_kpa, window.lower_kpa},
            {window.lower_mm, window.lower_mm, window.upper_mm, window.upper_mm, window.lower_mm}));
  return {"loops " + record.name,
          record.name + model::in_unit(": displacement over pressure, and an enlarged view of the frame in "
                                       "which the models differ most.",
                                       record.output_unit),
          {{whole, zoom}}};
}

Figure closed_loop_figure(const ClosedLoopCurves& curves) {
  Chart values, errors;
  const std::string unit(model::name_of(curves.output_unit));
  values.title = model::in_unit("displacement", curves.output_unit);
  values.y.label = errors.y.label = "[" + unit + "]";
  values.height = 160;
  errors.title = values.title + " minus reference";
  errors.x.label = "time [s]";
  errors.height = 150;
  values.series.push_back(curve("reference", Colour::measured, 2.4, curves.time_s, curves.reference_mm));
  std::string numbers;
  for (const ClosedLoopCurves::Scheme& scheme : curves.schemes) {
    // Each model keeps its line style in all figures, even if a figure shows only some of the models.
    const bool extended = scheme.name.starts_with("extended");
    const bool recalibrated = scheme.name.starts_with("recalibrated");
    const Colour colour = extended ? Colour::good : recalibrated ? Colour::model : Colour::other;
    Series way = curve(scheme.name, colour, 1.2, curves.time_s, scheme.displacement_mm);
    way.dash = extended ? Dash::solid : recalibrated ? Dash::dashed : Dash::dotted;
    Series error = way;
    error.label.clear();
    for (std::size_t t = 0; t < error.y.size(); ++t) error.y[t] -= curves.reference_mm[t];
    values.series.push_back(std::move(way));
    errors.series.push_back(std::move(error));
    numbers +=
        (numbers.empty() ? "" : ", ") + scheme.name + " " + significant(scheme.rmse_mm, 3) + " " + unit;
  }
  return {"closed loop",
          "In closed loop, " + curves.reference + ". RMSE: " + numbers +
              ". The controller gains of all schemes were found with the same search method.",
          stacked({values, errors})};
}

Figure spectrum_figure(const Diagnosis& d) {
  Chart chart;
  chart.height = 230;
  chart.x.label = "frequency [Hz]";
  chart.y.label = model::in_unit("error [mm\xc2\xb2/Hz]", d.extended_model.output_unit);
  chart.x.logarithmic = true;
  chart.y.logarithmic = true;
  const auto add = [&](const Shown& model, const ResidualEvidence& e) {
    chart.series.push_back(curve_of(model, e.spectrum.frequency_hz, e.spectrum.density_mm2_per_hz));
  };
  const std::vector<Shown> models = shown(d);
  add(models[0], d.evidence->as_given);
  add(models[1], d.evidence->recalibrated);
  if (is_extended(d)) add(models[2], d.evidence->extended);
  const SpectrumEvidence& s = d.evidence->recalibrated.spectrum;
  if (!s.frequency_hz.empty()) {
    // Spectral density of white noise. Its standard deviation is the noise of the readings, and it extends
    // from 0 to half the sampling rate.
    const double density = d.noise_mm * d.noise_mm / s.frequency_hz.back();
    chart.marks.push_back({Mark::Direction::horizontal, density, "noise of the readings"});
  }
  return {
      "spectrum of the error",
      is_clear(s.p_value, s.share_percent)
          ? "Spectrum of the error. Most significant spectral line that is not in the command: " +
                significant(s.peak_hz, 4) + " Hz, amplitude " + significant(s.peak_amplitude_mm, 2) + " " +
                std::string(model::name_of(d.extended_model.output_unit)) + " (p " +
                significant(s.p_value, 2) + ")."
          : "Spectrum of the error. This spectrum has no significant line that is not also in the command.",
      {{chart}}};
}

}  // namespace softgrip::sysid
