#include "sysid/logs/log.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <set>
#include <utility>

#include "base/files.h"
#include "base/interpolation.h"
#include "base/numbers.h"
#include "base/statistics.h"
#include "sysid/logs/csv_text.h"
#include "sysid/logs/finite_values.h"
#include "sysid/logs/log_columns.h"

namespace softgrip::sysid {
namespace {

/// Makes the names of the logs unique, because reports and JSON refer to logs by name. For example, the
/// second log with the name "run" becomes "run (2)".
void make_names_unique(std::vector<Log>& logs) {
  std::set<std::string> used;
  for (Log& log : logs) log.name = unique_name(log.name, used);
}

}  // namespace

std::string unique_name(const std::string& name, std::set<std::string>& used) {
  std::string unique = name;
  for (int count = 2; !used.insert(unique).second; ++count)
    unique = name + " (" + std::to_string(count) + ")";
  return unique;
}

tl::expected<std::string, std::string> log_file_of(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (!fs::is_directory(path, error)) return path;
  const fs::path file = fs::path(path) / "run.csv";
  if (fs::exists(file, error) || error) return file.string();
  return tl::unexpected(path + " is not a recording, because this folder contains no run.csv");
}

Campaign read_campaign(const std::vector<std::string>& paths, document::Problems& problems,
                       const LogOptions& options) {
  namespace fs = std::filesystem;
  Campaign campaign;
  LogOptions agreed = options;
  for (const std::string& given : paths) {
    std::error_code error;
    const bool folder = fs::is_directory(given, error);
    const auto file = log_file_of(given);
    const auto text = file ? read_file(*file, options.bytes) : tl::unexpected(file.error());
    if (!text) {
      problems.add({file.value_or(given), {1, 1}, {}, text.error(), {}});
      campaign.unreadable = true;
      continue;
    }
    const std::string& path = *file;
    auto log = parse_log(path, *text, problems, agreed);
    if (!log) continue;
    if (!agreed.output_unit && options.need_readings) {
      agreed.output_unit = log->output_unit;
      agreed.output_unit_of = path;
    }
    if (folder) {
      log->name = name_in_path(given) + (log->channel.empty() ? "" : "/" + log->channel);
    }
    campaign.logs.push_back(std::move(*log));
  }
  make_names_unique(campaign.logs);
  return campaign;
}

std::string format_log(const Log& log) {
  std::string text;
  std::vector<const KnownColumn*> present;
  for (const KnownColumn& known : known_columns) {
    if (!(log.*known.values).empty() || known.required) present.push_back(&known);
  }
  for (const KnownColumn* known : present)
    text += (text.empty() ? "" : ",") + std::string(column_name(*known, log));
  if (!log.channel.empty()) text += ',' + std::string(channel_column);
  for (const OtherColumn& other : log.others) text += ',' + as_cell(other.name);
  text += '\n';
  text.reserve(log.size() * present.size() * 20);
  for (std::size_t i = 0; i < log.size(); ++i) {
    bool first = true;
    for (const KnownColumn* known : present) {
      const double value = (log.*known->values)[i];
      if (!first) text += ',';
      if (std::isfinite(value)) text += shortest(value);
      first = false;
    }
    if (!log.channel.empty()) text += ',' + as_cell(log.channel);
    for (const OtherColumn& other : log.others) text += ',' + as_cell(other.cells[i]);
    text += '\n';
  }
  return text;
}

Sampling sampling_of(const Log& log) {
  Sampling sampling;
  std::vector<double> intervals(log.size());
  std::adjacent_difference(log.time_s.begin(), log.time_s.end(), intervals.begin());
  intervals.erase(intervals.begin());
  if (intervals.empty()) return sampling;
  auto sorted = intervals;
  std::sort(sorted.begin(), sorted.end());
  sampling.median_interval_s = sorted[sorted.size() / 2];
  sampling.shortest_interval_s = sorted.front();
  sampling.longest_interval_s = sorted.back();
  for (const double interval : intervals)
    sampling.jitter_s += std::abs(interval - sampling.median_interval_s);
  sampling.jitter_s /= static_cast<double>(intervals.size());
  const double tolerance = 1e-3 * sampling.median_interval_s;
  sampling.regular = sampling.longest_interval_s - sampling.shortest_interval_s <= 2 * tolerance;
  return sampling;
}

double span_mm(const Log& log) {
  return width_of(log.displacement_mm);
}

double largest_command_kpa(const std::vector<Log>& logs) {
  double largest = 0;
  for (const Log& log : logs) {
    for (const double p : log.pressure_command_kpa) largest = std::max(largest, p);
  }
  return largest;
}

bool have_same_command(const Log& log, const Log& other, double share) {
  const std::vector<double> others = interpolated(other.time_s, other.pressure_command_kpa, log.time_s);
  double squares = 0, largest_kpa = 0;
  for (std::size_t i = 0; i < others.size(); ++i) {
    squares += square(log.pressure_command_kpa[i] - others[i]);
    largest_kpa = std::max({largest_kpa, std::abs(log.pressure_command_kpa[i]), std::abs(others[i])});
  }
  return std::sqrt(squares / static_cast<double>(others.size())) <= share * largest_kpa;
}

Log slice(const Log& log, std::size_t first, std::size_t last) {
  const auto cut = [&](const auto& values) {
    using Values = std::decay_t<decltype(values)>;
    if (values.empty()) return Values{};
    return Values(values.begin() + static_cast<long>(first), values.begin() + static_cast<long>(last));
  };
  Log part;
  part.path = log.path;
  part.name = log.name;
  part.channel = log.channel;
  part.sha256 = log.sha256;
  part.output_unit = log.output_unit;
  for (const KnownColumn& known : known_columns) part.*known.values = cut(log.*known.values);
  for (const OtherColumn& other : log.others) part.others.push_back({other.name, cut(other.cells)});
  for (double& time : part.time_s) time -= log.time_s[first];
  return part;
}

}  // namespace softgrip::sysid
