#include "tools/importing/import_run.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/files.h"
#include "base/json.h"
#include "base/numbers.h"
#include "base/text.h"
#include "base/version.h"
#include "document/problem.h"
#include "sysid/import/conversion.h"
#include "sysid/import/missing_codes.h"
#include "sysid/import/proposal.h"
#include "sysid/import/role_fit.h"
#include "sysid/import/table_readers.h"
#include "sysid/logs/log.h"
#include "sysid/logs/plausibility_warnings.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/output.h"
#include "tools/command_line/terminal.h"

namespace softgrip::tools {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t longest_log = std::size_t{512} << 20U;

/// One file that is imported, with its mapping and its output path.
struct Job {
  std::string file;
  std::string out;
  sysid::ForeignTable table;
  sysid::Mapping mapping;
  std::vector<sysid::Role> guessed;
  bool is_log = false;  ///< true: the file is already a log, so it is copied
  sysid::ImportedLog result;
  std::vector<std::string> notes;
  std::vector<std::string> warnings;
  std::vector<std::string> plausibility;
};

/// Accepts a file that is already a log, including its additional columns. Returns false for any other file.
bool take_as_it_is(Job& job) {
  namespace fs = std::filesystem;
  if (sysid::column_index(job.table, "pressure_command_kpa") == job.table.columns.size()) return false;
  std::error_code error;
  const std::string path =
      fs::is_directory(job.file, error) ? (fs::path(job.file) / "run.csv").string() : job.file;
  const auto text = read_file(path, longest_log);
  document::Problems problems;
  sysid::LogOptions options;
  options.channel = job.mapping.channel;
  auto log = text ? sysid::parse_log(path, *text, problems, options) : std::nullopt;
  if (!log) return false;
  job.result.log = std::move(*log);
  job.result.account = job.table.account;
  job.result.account.used = job.result.log.size();
  const bool corrected = std::ranges::any_of(job.result.log.notes, &sysid::LogNote::corrects);
  job.result.notes.emplace_back(corrected ? "this file is already a log: copied with these corrections"
                                          : "this file is already a log: copied unchanged");
  job.warnings = job.table.warnings;
  job.is_log = true;
  return true;
}

bool says_columns(const sysid::Mapping& mapping) {
  for (const sysid::ColumnMapping& column : mapping.columns) {
    if (column != sysid::ColumnMapping{}) return true;
  }
  return mapping.rate_hz.has_value() || !mapping.missing.empty() || !mapping.missing_in.empty() ||
         mapping.separator != 0 || mapping.skip_bad_lines || !mapping.sheet.empty() || mapping.from_s > 0 ||
         std::isfinite(mapping.to_s);
}

/// Returns the words of --missing that are not numbers. Numbers are left out, because convert() recognises
/// them by their value.
std::vector<std::string> missing_words(const sysid::Mapping& mapping) {
  std::vector<std::string> words;
  for (const std::string& word : mapping.missing) {
    if (!sysid::missing_number(word)) words.push_back(word);
  }
  return words;
}

/// Returns true if a column contains codes for missing readings.
bool has_codes(const sysid::ForeignTable& table) {
  return std::any_of(table.columns.begin(), table.columns.end(), [](const sysid::TableColumn& column) {
    return std::any_of(sysid::roles.begin(), sysid::roles.end(), [&](const sysid::RoleSpec& spec) {
      return spec.role != sysid::Role::time && sysid::fitness_for(column, spec.role) > 0 &&
             !sysid::codes_for(column, spec.role).empty();
    });
  });
}

/// Reads a file and completes its mapping. Returns false if the file or the mapping is refused; the reason is
/// then in `problems`.
bool prepare(Job& job, const sysid::Mapping& given, document::Problems& problems, bool& unreadable) {
  job.mapping = given;
  auto table = sysid::read_foreign_file(
      job.file, {given.separator, missing_words(given), given.channel, given.skip_bad_lines, given.sheet},
      problems, unreadable);
  if (!table) return false;
  job.table = std::move(*table);
  if (!says_columns(given) && !has_codes(job.table) && take_as_it_is(job)) return true;
  sysid::Proposal proposal = sysid::propose(job.table, given, !given.complete());
  job.mapping = std::move(proposal.mapping);
  job.guessed = std::move(proposal.guessed);
  job.notes = std::move(proposal.notes);
  job.warnings = std::move(proposal.warnings);
  if (proposal.missing.empty() && proposal.questions.empty()) return true;
  std::fprintf(stderr, "%s: %s\n%s", job.file.c_str(), job.table.format.c_str(),
               sysid::mapping_table(job.table, job.mapping).c_str());
  for (const std::string& note : job.table.notes) std::fprintf(stderr, "  %s\n", on_screen(note).c_str());
  for (const std::string& missing : proposal.missing)
    problems.add({job.table.file, {1, 1}, {}, "no column looks like " + missing, {}});
  for (const sysid::Proposal::Question& question : proposal.questions)
    problems.add({job.table.file, {1, 1}, {}, question.text, question.hint});
  return false;
}

std::string command_line(const Job& job, const ImportOptions& options) {
  return "softgrip import " + shell_word(job.file) + " " + sysid::options_of(job.mapping) + " --out " +
         shell_word(options.out);
}

/// Prints the guessed roles of the columns. Returns false if no role of any column was guessed.
bool show_guesses(const std::vector<Job>& jobs) {
  bool guessed = false;
  for (const Job& job : jobs) {
    if (job.guessed.empty()) continue;
    guessed = true;
    std::fprintf(stderr, "%s: %s\n%s", job.file.c_str(), job.table.format.c_str(),
                 sysid::mapping_table(job.table, job.mapping).c_str());
  }
  return guessed;
}

/// Returns true if no role was guessed, if --yes is given, or if the user confirms the mapping.
bool agreed(const std::vector<Job>& jobs, const ImportOptions& options) {
  if (!show_guesses(jobs)) return true;
  for (const Job& job : jobs) {
    if (!job.guessed.empty())
      std::fprintf(stderr, "  equivalent command: %s\n", command_line(job, options).c_str());
  }
  if (options.yes) return true;
  if (::isatty(STDIN_FILENO) == 0) {
    std::fputs(
        "not written: the guessed column assignment cannot be confirmed, because the standard input is not a "
        "terminal. Repeat the command with the options above, or accept the guess with --yes\n",
        stderr);
    return false;
  }
  if (confirmed("Write " + options.out + " with this assignment?")) return true;
  std::fputs("not written; change the options above and repeat the command\n", stderr);
  return false;
}

sysid::PressureColumn pressure_column(const sysid::Mapping& mapping) {
  const auto role = mapping[sysid::Role::command].given() ? sysid::Role::command : sysid::Role::pressure;
  if (!mapping[role].given()) return {};
  return {mapping[role].columns.front(), std::string(sysid::spec_of(role).word)};
}

bool finish(Job& job, document::Problems& problems) {
  if (!job.is_log) {
    auto result = sysid::convert(job.table, job.mapping, problems);
    if (!result) return false;
    job.result = std::move(*result);
    job.warnings.insert(job.warnings.end(), job.result.warnings.begin(), job.result.warnings.end());
  }
  const bool reversed = job.mapping[sysid::Role::displacement].scale.value_or(1) < 0;
  job.plausibility =
      sysid::plausibility_warnings(job.result.log, pressure_column(job.mapping),
                                   reversed ? sysid::ReadingSign::reversed : sysid::ReadingSign::kept);
  return true;
}

std::vector<std::string> notes_of(const Job& job) {
  std::vector<std::string> notes = job.table.notes;
  notes.insert(notes.end(), job.notes.begin(), job.notes.end());
  notes.insert(notes.end(), job.result.notes.begin(), job.result.notes.end());
  for (const sysid::LogNote& note : job.result.log.notes) notes.push_back(note.text);
  return notes;
}

/// Returns the word for a column in the mapping file: the name or, if the file cannot contain the name, the
/// number of the column.
std::string readable_name(const sysid::ForeignTable& table, const std::string& word) {
  constexpr std::size_t longest_name = 1000;
  if (word.size() <= longest_name && document::shown(word, word.size()) == word) return word;
  const std::size_t index = sysid::column_index(table, word);
  const std::string number = std::to_string(index + 1);
  return index < table.columns.size() && sysid::column_index(table, number) == index ? number : word;
}

sysid::Mapping with_readable_names(const sysid::ForeignTable& table, sysid::Mapping mapping) {
  for (sysid::ColumnMapping& column : mapping.columns) {
    for (std::string& word : column.columns) word = readable_name(table, word);
  }
  for (sysid::ColumnCode& code : mapping.missing_in) code.column = readable_name(table, code.column);
  return mapping;
}

std::string mapping_path(const std::string& out) {
  return std::filesystem::path(out).replace_extension(".import.yaml").string();
}

tl::expected<void, std::string> write(const Job& job) {
  if (auto written = write_output(job.out, sysid::format_log(job.result.log)); !written) return written;
  if (is_stream(job.out) || job.is_log) return {};
  std::vector<std::string> remarks = notes_of(job);
  remarks.push_back(job.result.account.sentence());
  for (const std::string& warning : job.warnings) remarks.push_back("warning: " + warning);
  for (const std::string& implausible : job.plausibility) remarks.push_back("warning: " + implausible);
  return write_file(mapping_path(job.out),
                    sysid::mapping_yaml(with_readable_names(job.table, job.mapping),
                                        {job.file, job.table.sha256, job.table.format},
                                        "softgrip " + std::string(software_version()), remarks));
}

ordered_json account_json(const sysid::RowAccount& account) {
  ordered_json left_out = ordered_json::object();
  for (std::size_t i = 0; i < sysid::left_out_count; ++i) {
    if (account.left_out[i] > 0)
      left_out[std::string(sysid::word_of(static_cast<sysid::LeftOut>(i)))] = account.left_out[i];
  }
  return {{"file", account.rows}, {"used", account.used}, {"joined", account.joined}, {"left_out", left_out}};
}

ordered_json json_of(const Job& job) {
  const sysid::Log& log = job.result.log;
  ordered_json columns = ordered_json::object();
  for (const sysid::RoleSpec& spec : sysid::roles) {
    const sysid::ColumnMapping& column = job.mapping[spec.role];
    if (!column.given()) continue;
    columns[std::string(spec.word)] = {{"columns", column.columns},
                                       {"unit", sysid::unit_text(job.table, column, spec.quantity)}};
  }
  return {{"file", job.file},
          {"format", job.table.format},
          {"sha256", job.table.sha256},
          {"out", job.out},
          {"samples", log.size()},
          {"duration_s", log.time_s.back()},
          {"output_unit", model::name_of(log.output_unit)},
          {"columns", columns},
          {"options", sysid::options_of(job.mapping)},
          {"rows", account_json(job.result.account)},
          {"warnings", job.warnings},
          {"notes", notes_of(job)},
          {"plausibility_warnings", job.plausibility},
          {"doubts", job.plausibility}};
}

void report(const std::vector<Job>& jobs, const ImportOptions& options) {
  std::FILE* const stream = report_stream(options.out);
  ordered_json logs = ordered_json::array();
  for (const Job& job : jobs) {
    for (const std::string& warning : job.warnings)
      std::fprintf(stderr, "%s: warning: %s\n", job.file.c_str(), on_screen(warning).c_str());
    for (const std::string& implausible : job.plausibility)
      std::fprintf(stderr, "%s: warning: %s\n", job.file.c_str(), implausible.c_str());
    logs.push_back(json_of(job));
    if (options.json) continue;
    for (const std::string& note : notes_of(job))
      std::fprintf(stream, "%s: %s\n", job.file.c_str(), on_screen(note).c_str());
    std::fprintf(stream, "%s: %s\n", job.file.c_str(), job.result.account.sentence().c_str());
    std::fprintf(stream, "%s (%s): %zu samples, %s s -> %s\n", job.file.c_str(), job.table.format.c_str(),
                 job.result.log.size(), significant(job.result.log.time_s.back(), 6).c_str(),
                 job.out.c_str());
  }
  if (options.json) {
    const ordered_json all{{"schema", 1}, {"logs", logs}};
    std::fprintf(stream, "%s\n", json_dump(all).c_str());
  }
}

/// Refuses output paths that would overwrite an input. The new mapping file may overwrite the file of --map,
/// because the new file also contains the settings of the file of --map.
std::optional<ExitCode> refuse_own_inputs(const ImportOptions& options,
                                          const std::vector<std::string>& targets) {
  std::vector<std::string> outputs = targets;
  for (const std::string& target : targets) {
    if (!is_stream(target)) outputs.push_back(mapping_path(target));
  }
  if (const auto code = refuse_overwriting(outputs, options.files)) return code;
  return refuse_overwriting(targets, {options.map});
}

}  // namespace

ExitCode run_import(const ImportOptions& options) {
  if (const auto checked = check_files(options); !checked) return fail(ExitCode::usage, checked.error());
  const auto targets = import_targets(options.files, options.out);
  if (!targets) return fail(ExitCode::usage, targets.error());
  if (const auto code = refuse_own_inputs(options, *targets)) return *code;
  document::Problems problems;
  sysid::Mapping begun;
  if (!options.map.empty()) {
    if (const auto code = unreadable(options.map)) return *code;
    const auto read = sysid::read_mapping(options.map, problems);
    if (!read) return refuse(problems);
    begun = *read;
  }
  const auto mapping = mapping_of(options, std::move(begun));
  if (!mapping) return fail(ExitCode::usage, mapping.error());

  std::vector<Job> jobs(options.files.size());
  bool unreadable_file = false;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    jobs[i].file = options.files[i];
    jobs[i].out = (*targets)[i];
    (void)prepare(jobs[i], *mapping, problems, unreadable_file);
  }
  // Convert all files first, so that the user must confirm the mapping only if no file has a problem.
  for (Job& job : jobs) {
    if (problems.empty() && !finish(job, problems)) (void)show_guesses(jobs);
  }
  if (problems.empty() && !agreed(jobs, options)) return ExitCode::usage;
  if (!problems.empty()) {
    const ExitCode refused = refuse(problems);
    return unreadable_file ? ExitCode::io : refused;
  }
  for (const Job& job : jobs) {
    if (const auto written = write(job); !written) return fail(ExitCode::io, written.error());
  }
  report(jobs, options);
  return ExitCode::done;
}

}  // namespace softgrip::tools
