#include "sysid/identification/log_figures.h"

#include <cmath>

#include "base/numbers.h"

namespace softgrip::sysid {
namespace {

Series line(std::string label, const std::vector<double>& x, const std::vector<double>& y, Colour colour) {
  Series series;
  series.label = std::move(label);
  series.x = x;
  series.y = y;
  series.colour = colour;
  return series;
}

}  // namespace

std::vector<Chart> overlay(const Record& record, const Score& score) {
  Chart values;
  values.title = record.name;
  values.y.label = model::in_unit("displacement [mm]", record.output_unit);
  values.height = 260;
  Series measured = line("measured", record.time_s, record.reading_mm, Colour::measured);
  measured.width = 2.2;
  values.series = {measured, line("model", record.time_s, score.prediction_mm, Colour::model)};
  Chart error;
  error.y.label = model::in_unit("error [mm]", record.output_unit);
  error.x.label = "time [s]";
  error.height = 170;
  Series difference = line("", record.time_s, score.error_mm, Colour::error);
  difference.width = 1;
  error.series = {difference};
  const std::vector<std::size_t> cycles = cycle_starts(record);
  if (cycles.size() > 1)
    error.marks.push_back({Mark::Direction::vertical, record.time_s[cycles[1]], "settled"});
  return {values, error};
}

Chart loops(const Record& record, const Score& score) {
  Chart chart;
  chart.width = 380;
  chart.height = 300;
  chart.x.label = "pressure [kPa]";
  chart.y.label = model::in_unit("displacement [mm]", record.output_unit);
  Series measured = line("measured", record.drive_kpa, record.reading_mm, Colour::measured);
  measured.width = 2.2;
  Series model = line("model", record.drive_kpa, score.prediction_mm, Colour::model);
  model.width = 1;
  chart.series = {measured, model};
  return chart;
}

Chart error_by_pressure(const Record& record, const Score& score) {
  Chart chart;
  chart.width = 380;
  chart.height = 300;
  chart.x.label = "pressure [kPa]";
  chart.y.label = model::in_unit("error [mm]", record.output_unit);
  Series loading;
  loading.style = Series::Style::points;
  loading.width = 0.7;
  Series unloading = loading;
  loading.label = "loading";
  loading.colour = Colour::model;
  unloading.label = "unloading";
  unloading.colour = Colour::error;
  for (std::size_t i = 1; i < record.size(); ++i) {
    const double change = record.drive_kpa[i] - record.drive_kpa[i - 1];
    if (change == 0) continue;
    Series& series = change > 0 ? loading : unloading;
    series.x.push_back(record.drive_kpa[i]);
    series.y.push_back(score.error_mm[i]);
  }
  chart.series = {loading, unloading};
  return chart;
}

void add_log_figures(Page& page, const Record& record, const Score& score) {
  page.figure({record.name + " over time",
               record.name + ": measured displacement and model over time, and the difference between them.",
               stacked(overlay(record, score))});
  page.figure({record.name + " over pressure",
               record.name + ": hysteresis loops, and the error over the pressure.",
               {{loops(record, score), error_by_pressure(record, score)}}});
}

std::string or_dash(double value, int digits) {
  return std::isfinite(value) ? significant(value, digits) : "\xe2\x80\x93";
}

Table score_table(const std::vector<Record>& records, const std::vector<Score>& scores) {
  Table table;
  table.header = {"log",         "driven by",    "samples",
                  "span [mm]",   "RMSE [mm]",    "RMSE [% of span]",
                  "first cycle", "settled [mm]", "largest error [mm]"};
  for (std::string& title : table.header)
    if (!scores.empty()) title = model::in_unit(title, scores.front().output_unit);
  table.numeric = {false, false, true, true, true, true, true, true, true};
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const Score& s = scores[i];
    std::size_t samples = 0;
    for (const double e : s.error_mm) {
      if (std::isfinite(e)) ++samples;
    }
    table.rows.push_back({s.name, name_of(s.drive), std::to_string(samples), or_dash(records[i].span_mm),
                          or_dash(s.rmse_mm), or_dash(s.rmse_percent_of_span), or_dash(s.first_cycle_rmse_mm),
                          or_dash(s.settled_rmse_mm), or_dash(s.largest_error_mm)});
  }
  return table;
}

}  // namespace softgrip::sysid
