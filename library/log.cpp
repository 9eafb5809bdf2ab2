#include "library/include/softgrip/log.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/files.h"
#include "base/numbers.h"
#include "document/problem.h"
#include "library/log_parts.h"
#include "library/model_parts.h"
#include "sysid/import/conversion.h"
#include "sysid/import/mapping.h"
#include "sysid/import/proposal.h"
#include "sysid/import/table_readers.h"
#include "sysid/logs/command_before.h"
#include "sysid/logs/log.h"

namespace softgrip {
namespace {

/// A column of a log that may be empty.
struct OptionalColumn {
  const char* name;
  const char* unit;
  std::vector<double> Log::*values;
  std::vector<double> sysid::Log::*as;
  bool may_lack_readings;
};
constexpr OptionalColumn optional_columns[] = {
    {"pressure_kpa", "kPa", &Log::pressure_kpa, &sysid::Log::pressure_kpa, true},
    {"temperature_c", "degrees Celsius", &Log::temperature_c, &sysid::Log::temperature_c, false},
    {"supply_kpa", "kPa", &Log::supply_kpa, &sysid::Log::supply_kpa, false}};

void require_no_infinity(const std::string& argument, const std::vector<double>& values,
                         const std::string& unit) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isinf(values[i]))
      throw InvalidArgument(argument, "value " + std::to_string(i) + " is " + shortest(values[i]) +
                                          ". A missing reading is NaN; other values must be finite, in " +
                                          unit);
  }
}

/// Converts the columns of a log, and shifts the times so that the first time is 0. Throws InvalidArgument if
/// the number of values is wrong or a value is invalid.
sysid::Log columns_of(const Log& log) {
  const std::string unit = name_of(log.unit);
  library::require_times("time_s", log.time_s, 2);
  library::require_size("pressure_command_kpa", log.pressure_command_kpa.size(), log.time_s.size(), "kPa");
  library::require_finite("pressure_command_kpa", log.pressure_command_kpa, "kPa");
  library::require_size("displacement", log.displacement.size(), log.time_s.size(), unit);
  require_no_infinity("displacement", log.displacement, unit);
  sysid::Log result;
  result.time_s = log.time_s;
  if (const double first_s = log.time_s.front(); first_s != 0) {
    for (double& time_s : result.time_s) time_s -= first_s;
  }
  result.pressure_command_kpa = log.pressure_command_kpa;
  result.displacement_mm = log.displacement;
  result.output_unit = library::unit_of(log.unit);
  for (const OptionalColumn& column : optional_columns) {
    const std::vector<double>& values = log.*column.values;
    if (values.empty()) continue;
    library::require_size(column.name, values.size(), log.time_s.size(), column.unit);
    if (column.may_lack_readings) {
      require_no_infinity(column.name, values, column.unit);
    } else {
      library::require_finite(column.name, values, column.unit);
    }
    result.*column.as = values;
  }
  return result;
}

std::string sentence_of(const document::Problems& problems) {
  const document::Problem& first = problems.list().front();
  return first.hint.empty() ? first.message : first.message + " (" + first.hint + ")";
}

/// Checks a log with the reader of log files, so that logs from arrays must satisfy the same conditions as
/// log files.
sysid::Log accepted(const std::string& argument, const Log& log, const sysid::LogOptions& options) {
  document::Problems problems;
  const std::string name = log.name.empty() ? "log" : log.name;
  auto read = sysid::parse_log(name, sysid::format_log(columns_of(log)), problems, options);
  if (!read) throw InvalidArgument(argument, name + ": " + sentence_of(problems));
  read->name = name;
  read->path = log.path;
  read->sha256 = log.sha256;
  return *std::move(read);
}

Log public_log(sysid::Log log) {
  Log result;
  result.name = std::move(log.name);
  result.time_s = std::move(log.time_s);
  result.pressure_command_kpa = std::move(log.pressure_command_kpa);
  result.displacement = std::move(log.displacement_mm);
  result.unit = library::unit_of(log.output_unit);
  for (const OptionalColumn& column : optional_columns) result.*column.values = std::move(log.*column.as);
  result.path = std::move(log.path);
  result.sha256 = std::move(log.sha256);
  for (sysid::LogNote& note : log.notes) result.notes.push_back(std::move(note.text));
  return result;
}

sysid::Role role_named(const std::string& argument, const std::string& word) {
  const auto* const found = std::find_if(sysid::roles.begin(), sysid::roles.end(),
                                         [&](const sysid::RoleSpec& spec) { return spec.word == word; });
  if (found != sysid::roles.end()) return found->role;
  std::string all;
  for (const sysid::RoleSpec& spec : sysid::roles) all += " " + std::string(spec.word);
  throw InvalidArgument(argument, "'" + word + "' is not a role of a column; the roles are" + all);
}

sysid::Mapping mapping_of(const ReadOptions& options) {
  sysid::Mapping mapping;
  for (const auto& [role, column] : options.columns) mapping[role_named("columns", role)].columns = {column};
  for (const auto& [role, unit] : options.units) mapping[role_named("units", role)].unit = unit;
  if (options.rate_hz) library::require_positive("rate_hz", *options.rate_hz, "Hz");
  mapping.rate_hz = options.rate_hz;
  mapping.channel = options.channel;
  mapping.sheet = options.sheet;
  return mapping;
}

Log imported(const std::string& path, const ReadOptions& options) {
  const sysid::Mapping given = mapping_of(options);
  document::Problems problems;
  bool unreadable = false;
  const auto table =
      sysid::read_foreign_file(path, {0, {}, given.channel, false, given.sheet}, problems, unreadable);
  if (!table) library::refuse(problems);
  sysid::Proposal proposal = sysid::propose(*table, given, !given.complete());
  for (const std::string& missing : proposal.missing)
    problems.add({path, {1, 1}, {}, "no column looks like " + missing, {}});
  for (const sysid::Proposal::Question& question : proposal.questions)
    problems.add({path, {1, 1}, {}, question.text, question.hint});
  if (!problems.empty()) library::refuse(problems);
  auto converted = sysid::convert(*table, proposal.mapping, problems);
  if (!converted) library::refuse(problems);
  Log log = public_log(std::move(converted->log));
  if (log.name.empty()) log.name = std::filesystem::path(path).stem().string();
  log.path = path;
  log.sha256 = table->sha256;
  log.notes.push_back("imported (" + table->format + "): softgrip import " +
                      sysid::options_of(proposal.mapping));
  for (std::string& note : converted->notes) log.notes.push_back(std::move(note));
  for (std::string& warning : proposal.warnings) log.notes.push_back("warning: " + warning);
  for (std::string& warning : converted->warnings) log.notes.push_back("warning: " + warning);
  return log;
}

}  // namespace

namespace library {

sysid::RecordOptions record_options(const LogUse& use) {
  sysid::RecordOptions options;
  options.drive = use.drive == Drive::measured ? sysid::Drive::measured : sysid::Drive::command;
  options.start = use.begin == Begin::rest      ? sysid::Start::rest
                  : use.begin == Begin::unknown ? sysid::Start::unknown
                                                : sysid::Start::automatic;
  options.held = use.held;
  return options;
}

NeededUnit needed_for(const Model& model) {
  return {"the model " + model.name(), model.unit()};
}

std::vector<sysid::Log> checked_logs(const std::string& argument, const std::vector<Log>& logs,
                                     const LogUse& use, bool measured_stay,
                                     const std::optional<NeededUnit>& needed) {
  if (logs.empty()) throw InvalidArgument(argument, "0 logs were given; at least 1 log is required");
  sysid::LogOptions options;
  options.output_unit = unit_of(needed ? needed->unit : logs.front().unit);
  options.output_unit_of = needed ? needed->of : logs.front().name;
  std::vector<sysid::Log> result;
  for (const Log& log : logs) {
    result.push_back(accepted(argument, log, options));
    if (use.drive == Drive::measured && log.pressure_kpa.empty())
      throw InvalidArgument(
          argument,
          result.back().name +
              ": the drive 'measured' requires pressure_kpa (in kPa), which this log does not have");
  }
  if (use.drive == Drive::command) sysid::begin_before_first_command(result, measured_stay);
  return result;
}

}  // namespace library

Log read_log(const std::string& path, const ReadOptions& options) {
  if (!options.columns.empty() || options.rate_hz || !options.sheet.empty()) return imported(path, options);
  document::Problems problems;
  sysid::LogOptions log_options;
  log_options.channel = options.channel;
  sysid::Campaign campaign = sysid::read_campaign({path}, problems, log_options);
  if (!campaign.logs.empty()) return public_log(std::move(campaign.logs.front()));
  if (campaign.unreadable || !options.import_file) library::refuse(problems);
  try {
    return imported(path, options);
  } catch (const FileError&) {
    // A file with the column pressure_command_kpa is meant to be a log of softgrip. Therefore, its problems
    // as a log are reported, and the file is not imported.
    const auto text = read_file(path, sysid::LogOptions{}.bytes);
    if (text && text->substr(0, text->find('\n')).find("pressure_command_kpa") != std::string::npos)
      library::refuse(problems);
    throw;
  }
}

void write_log(const std::string& path, const Log& log) {
  if (const auto written = write_file(path, sysid::format_log(columns_of(log))); !written)
    throw FileError(written.error());
}

void check(const Log& log) {
  (void)accepted("log", log, {});
}

}  // namespace softgrip
