#include "sysid/logs/series.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/numbers.h"
#include "sysid/logs/csv_text.h"

namespace softgrip::sysid {
namespace {

std::string cell(double value) {
  return std::isfinite(value) ? shortest(value) : std::string();
}

}  // namespace

LogSeries series_of(const Log& log, const Record& record, bool all_held_out) {
  LogSeries series;
  // An averaged record has other samples than the log from which it was made.
  const bool own_samples = record.size() == log.size();
  series.name = log.name;
  series.output_unit = record.output_unit;
  series.time_s = own_samples ? log.time_s : record.time_s;
  series.drive_kpa = record.drive_kpa;
  series.measured_mm = own_samples ? log.displacement_mm : record.reading_mm;
  series.held_out.resize(record.size());
  for (std::size_t i = 0; i < record.size(); ++i) {
    const bool read = std::isfinite(series.measured_mm[i]);
    series.held_out[i] = read && (all_held_out || !std::isfinite(record.reading_mm[i]));
  }
  return series;
}

std::string series_csv(const LogSeries& series) {
  const std::string unit = "_" + std::string(model::name_of(series.output_unit));
  std::string text = "time_s,drive_kpa,measured" + unit;
  for (const LogSeries::Predicted& predicted : series.predicted) {
    text += ',' + as_cell("predicted_" + predicted.model + unit);
    text += ',' + as_cell("residual_" + predicted.model + unit);
  }
  text += ",held_out\n";
  text.reserve(series.time_s.size() * (60 + 40 * series.predicted.size()));
  for (std::size_t i = 0; i < series.time_s.size(); ++i) {
    text += shortest(series.time_s[i]) + ',' + cell(series.drive_kpa[i]) + ',' + cell(series.measured_mm[i]);
    for (const LogSeries::Predicted& predicted : series.predicted)
      text += ',' + cell(predicted.mm[i]) + ',' + cell(series.measured_mm[i] - predicted.mm[i]);
    text += !series.held_out.empty() && series.held_out[i] ? ",1\n" : ",0\n";
  }
  return text;
}

std::string series_path(std::string_view log_name) {
  constexpr std::string_view kept = "-_. ()";
  std::string folder;
  for (const char c : log_name) {
    const bool plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || kept.find(c) != std::string_view::npos;
    folder += plain ? c : '_';
  }
  const bool only_dots = folder.find_first_not_of('.') == std::string::npos;
  return (only_dots ? "log" : folder) + "/series.csv";
}

}  // namespace softgrip::sysid
