#include "tools/commands/series_output.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "base/files.h"
#include "sysid/fitting/trajectory.h"
#include "tools/command_line/command.h"
#include "tools/command_line/output.h"
#include "tools/verification/verification.h"

namespace softgrip::tools {

std::vector<sysid::LogSeries> series_of(const std::vector<sysid::Log>& logs,
                                        const std::vector<sysid::Record>& records,
                                        const std::vector<sysid::Score>& scores, const std::string& model,
                                        bool held_out) {
  std::vector<sysid::LogSeries> all;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    all.push_back(sysid::series_of(logs[i], records[i], held_out));
    all.back().predicted.push_back({model, scores[i].prediction_mm});
  }
  return all;
}

std::vector<sysid::LogSeries> series_of(const sysid::Diagnosis& diagnosis,
                                        const std::vector<sysid::Log>& logs) {
  std::vector<std::pair<const char*, const sysid::StructureFit*>> fits{
      {"given", &diagnosis.as_given}, {"recalibrated", &diagnosis.recalibrated}};
  if (sysid::is_extended(diagnosis)) fits.emplace_back("extended", &diagnosis.extended);
  std::vector<sysid::LogSeries> all;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const sysid::Record& record = diagnosis.records[i];
    all.push_back(sysid::series_of(logs[i], record, false));
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
  if (out.empty()) return std::nullopt;
  for (const ReportKind& other : report_kinds) {
    const std::string path = (std::filesystem::path(out) / other.json).string();
    if (std::ranges::count(names, other.json) > 0 || !is_there(path)) continue;
    return fail(ExitCode::state_refused,
                path + " already exists: its report.html would be replaced. Name another folder with --out");
  }
  return std::nullopt;
}

void add_figures_option(CLI::App& command, std::string& folder) {
  command.add_option("--figures", folder,
                     "Folder for each figure of the report: SVG, PDF, and its data as CSV");
}

tl::expected<void, std::string> write_series(const std::string& folder,
                                             const std::vector<sysid::LogSeries>& series) {
  std::map<std::string, int> seen;
  for (const sysid::LogSeries& one : series) {
    // A log may be an input twice: for the fit and for the prediction. The second series of this log needs a
    // different folder.
    const std::string plain = sysid::series_path(one.name);
    const int count = ++seen[plain];
    const std::string name =
        count == 1 ? plain : sysid::series_path(one.name + " (" + std::to_string(count) + ")");
    const std::string path = (std::filesystem::path(folder) / name).string();
    if (auto written = write_file(path, series_csv(one)); !written) return written;
  }
  return {};
}

}  // namespace softgrip::tools
