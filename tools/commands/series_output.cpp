#include "tools/commands/series_output.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <set>
#include <system_error>
#include <utility>

#include "base/files.h"
#include "base/numbers.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/logs/csv_text.h"
#include "tools/command_line/command.h"
#include "tools/command_line/output.h"
#include "tools/verification/verification.h"

namespace softgrip::tools {
namespace {

std::string cell(double value) {
  return std::isfinite(value) ? shortest(value) : std::string();
}

/// Returns an exit code if one of the folders cannot be created or written. No folder remains. Names may be
/// empty.
std::optional<ExitCode> refuse_unwritable(std::initializer_list<std::string> folders) {
  namespace fs = std::filesystem;
  for (const std::string& folder : folders) {
    if (folder.empty()) continue;
    std::error_code ignored;
    std::vector<fs::path> missing;
    for (fs::path path = folder; !path.empty() && !fs::exists(path, ignored); path = path.parent_path())
      missing.push_back(path);
    const auto ready = prepare_folder(folder);
    for (const fs::path& path : missing) fs::remove(path, ignored);
    if (!ready) return fail(ExitCode::io, ready.error());
  }
  return std::nullopt;
}

}  // namespace

LogSeries series_of(const sysid::Log& log, const sysid::Record& record, bool all_held_out) {
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
    text += ',' + sysid::as_cell("predicted_" + predicted.model + unit);
    text += ',' + sysid::as_cell("residual_" + predicted.model + unit);
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

std::string series_folder(std::string_view log_name) {
  constexpr std::string_view kept = "-_. ()";
  std::string folder;
  for (const char c : log_name) {
    const bool plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || kept.find(c) != std::string_view::npos;
    folder += plain ? c : '_';
  }
  const bool only_dots = folder.find_first_not_of('.') == std::string::npos;
  return only_dots ? "log" : folder;
}

std::vector<LogSeries> series_of(const std::vector<sysid::Log>& logs,
                                 const std::vector<sysid::Record>& records,
                                 const std::vector<sysid::Score>& scores, const std::string& model,
                                 bool held_out) {
  std::vector<LogSeries> all;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    all.push_back(series_of(logs[i], records[i], held_out));
    all.back().predicted.push_back({model, scores[i].prediction_mm});
  }
  return all;
}

std::vector<LogSeries> series_of(const sysid::Diagnosis& diagnosis, const std::vector<sysid::Log>& logs) {
  std::vector<std::pair<const char*, const sysid::StructureFit*>> fits{
      {"given", &diagnosis.as_given}, {"recalibrated", &diagnosis.recalibrated}};
  if (sysid::is_extended(diagnosis)) fits.emplace_back("extended", &diagnosis.extended);
  std::vector<LogSeries> all;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const sysid::Record& record = diagnosis.records[i];
    all.push_back(series_of(logs[i], record, false));
    // Outliers were excluded from the fit, but they were not held out for validation.
    all.back().held_out.clear();
    for (const auto& [name, fit] : fits) {
      if (i < fit->point.starts.size())
        all.back().predicted.push_back(
            {name, sysid::predict(fit->point.model, record, fit->point.starts[i])});
    }
  }
  return all;
}

std::optional<ExitCode> refuse_report(const std::string& out, const std::string& figures,
                                      std::vector<std::string> names,
                                      const std::vector<std::string>& inputs) {
  names.emplace_back("report.html");
  names.emplace_back("*/series.csv");
  std::vector<std::string> files = files_in(out, names);
  for (std::string& file : files_in(figures, {"figure-*"})) files.push_back(std::move(file));
  if (const auto code = refuse_overwriting(files, inputs)) return code;
  if (out.empty()) return refuse_unwritable({figures});
  for (const ReportKind& other : report_kinds) {
    const std::string path = (std::filesystem::path(out) / other.json).string();
    if (std::ranges::count(names, other.json) > 0 || !is_there(path)) continue;
    return fail(ExitCode::state_refused,
                path + " already exists: its report.html would be replaced. Name another folder with --out");
  }
  return refuse_unwritable({out, figures});
}

void add_figures_option(CLI::App& command, std::string& folder) {
  command.add_option("--figures", folder,
                     "Folder for each figure of the report: SVG, PDF, and its data as CSV");
}

tl::expected<void, std::string> write_series(const std::string& folder,
                                             const std::vector<LogSeries>& series) {
  std::set<std::string> used;
  for (const LogSeries& one : series) {
    // A log may be an input twice: for the fit and for the prediction. The second series of this log needs a
    // different folder.
    const std::string name = sysid::unique_name(series_folder(one.name), used) + "/series.csv";
    const std::string path = (std::filesystem::path(folder) / name).string();
    if (auto written = write_file(path, series_csv(one)); !written) return written;
  }
  return {};
}

}  // namespace softgrip::tools
