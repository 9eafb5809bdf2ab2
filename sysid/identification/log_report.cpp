#include "sysid/identification/log_report.h"

#include <cmath>

#include "base/numbers.h"
#include "sysid/logs/finite_values.h"

namespace softgrip::sysid {
namespace {

using result::Fields, result::Value;

Series line(std::string label, const std::vector<double>& x, const std::vector<double>& y, Colour colour) {
  Series series;
  series.label = std::move(label);
  series.x = x;
  series.y = y;
  series.colour = colour;
  return series;
}

Fields fields_of_note(const LogNote& note) {
  return {{"line", note.line}, {"text", note.text}};
}

Fields fields_of_log(const Log& log) {
  Fields fields{{"name", log.name}, {"path", log.path}, {"sha256", log.sha256}};
  if (!log.channel.empty()) fields.emplace_back("channel", log.channel);
  fields.emplace_back("samples", log.size());
  fields.emplace_back("duration_s", log.time_s.empty() ? 0 : log.time_s.back() - log.time_s.front());
  if (!log.notes.empty()) fields.emplace_back("notes", result::list_of(log.notes, fields_of_note));
  return fields;
}

Fields fields_of_score(const Score& s, double span_mm) {
  const auto in_unit = [&](const char* title) { return model::in_unit(title, s.output_unit); };
  return {{"", "log", s.name},
          {"drive", "driven by", name_of(s.drive)},
          {"", "samples", finite_count(s.error_mm)},
          {"", in_unit("span [mm]"), or_dash(span_mm)},
          {"rmse_mm", in_unit("RMSE [mm]"), or_dash(s.rmse_mm)},
          {"rmse_percent_of_span", "RMSE [% of span]", or_dash(s.rmse_percent_of_span)},
          {"first_cycle_rmse_mm", "RMSE of the first cycle", or_dash(s.first_cycle_rmse_mm)},
          {"settled_rmse_mm", in_unit("RMSE after the first cycle [mm]"), or_dash(s.settled_rmse_mm)},
          {"largest_error_mm", in_unit("largest error [mm]"), or_dash(s.largest_error_mm)}};
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
               record.name + ": measured displacement and prediction of the model over time, and the "
                             "difference between the two curves.",
               stacked(overlay(record, score))});
  page.figure(
      {record.name + " over pressure",
       record.name +
           ": hysteresis loops (displacement over pressure), and the error of the model over the pressure.",
       {{loops(record, score), error_by_pressure(record, score)}}});
}

Value logs_value(const std::vector<Log>& logs) {
  return result::list_of(logs, fields_of_log);
}

Fields fields_of(const std::vector<Score>& scores) {
  Fields fields;
  if (scores.empty()) return fields;
  std::vector<Fields> rows;
  for (const Score& s : scores) rows.push_back(fields_of_score(s, 0));
  for (std::size_t i = 0; i < rows.front().size(); ++i) {
    if (rows.front()[i].key.empty()) continue;
    Fields by_log;
    for (std::size_t j = 0; j < scores.size(); ++j) by_log.emplace_back(scores[j].name, rows[j][i].value);
    fields.emplace_back(rows.front()[i].key, std::move(by_log));
  }
  return fields;
}

result::Table score_table(const std::vector<Record>& records, const std::vector<Score>& scores) {
  std::vector<Fields> rows;
  for (std::size_t i = 0; i < scores.size(); ++i)
    rows.push_back(fields_of_score(scores[i], records[i].span_mm));
  return result::table_of("", rows.empty() ? fields_of_score({}, 0) : rows.front(), rows);
}

Value or_dash(const std::optional<double>& value) {
  const bool known = value && std::isfinite(*value);
  return result::shown(value, known ? significant(*value, 3) : "\xe2\x80\x93", true);
}

}  // namespace softgrip::sysid
