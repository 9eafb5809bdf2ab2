// Interprets the options of `softgrip import`: mapping_of() and import_targets() of
// tools/importing/import_run.h.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <set>
#include <utility>

#include "base/files.h"
#include "base/numbers.h"
#include "tools/importing/import_run.h"

namespace softgrip::tools {
namespace {

namespace fs = std::filesystem;
/// Stores the value of a word in a column. Returns false if the value is invalid.
using Taken = std::function<bool(sysid::ColumnMapping&, const std::string&)>;

/// Adds settings such as "pressure=psi" from the words of an option to a mapping. The error names the first
/// invalid word.
/// @param values  description of the valid values.
tl::expected<void, std::string> apply(const std::vector<std::string>& words, const std::string& option,
                                      const char* values, sysid::Mapping& mapping, const Taken& take) {
  for (const std::string& word : words) {
    const std::size_t equals = word.find('=');
    const std::string role = word.substr(0, equals);
    const auto spec = std::find_if(sysid::roles.begin(), sysid::roles.end(),
                                   [&](const sysid::RoleSpec& s) { return s.word == role; });
    if (equals == std::string::npos || equals + 1 == word.size() || spec == sysid::roles.end())
      return tl::unexpected(
          option + " " + word +
          ": ROLE=VALUE is expected; roles are time, command, pressure, displacement, temperature, supply");
    if (!take(mapping[spec->role], word.substr(equals + 1)))
      return tl::unexpected(option + " " + word + ": the value of " + role + " must be " + values);
  }
  return {};
}

bool take_scale(sysid::ColumnMapping& column, const std::string& text) {
  const auto value = to_number(text);
  if (!value || !std::isfinite(*value) || *value == 0) return false;
  column.scale = *value;
  return true;
}

bool take_zero(sysid::ColumnMapping& column, const std::string& text) {
  const auto value = to_number(text);
  column.zero_first = text == "first";
  if (column.zero_first) {
    column.zero.reset();
    return true;
  }
  if (!value || !std::isfinite(*value)) return false;
  column.zero = *value;
  return true;
}

/// Returns the codes that --missing-in states as COLUMN=NUMBER. The name of a column may contain '='.
tl::expected<std::vector<sysid::ColumnCode>, std::string> codes_of(const std::vector<std::string>& words) {
  std::vector<sysid::ColumnCode> codes;
  for (const std::string& word : words) {
    const std::size_t equals = word.rfind('=');
    const auto value = equals == std::string::npos ? std::nullopt : to_number(word.substr(equals + 1));
    if (!value || !std::isfinite(*value) || equals == 0)
      return tl::unexpected("--missing-in " + word + ": COLUMN=NUMBER is expected, for example tip_mm=999");
    codes.push_back({word.substr(0, equals), *value});
  }
  return codes;
}

/// Returns the name of the log that is imported from a file or folder: day1.csv for "day1.csv.gz" and for the
/// folder "day1".
std::string log_name(const std::string& file) {
  fs::path path = plain_path(file);
  if (path.extension() == ".gz") path = path.stem();
  std::error_code error;
  return (fs::is_directory(file, error) ? path.filename() : path.stem()).string() + ".csv";
}

/// Returns true if the word has the form ROLE=VALUE.
bool is_setting(const std::string& word) {
  const std::size_t equals = word.find('=');
  return equals != std::string::npos &&
         std::any_of(sysid::roles.begin(), sysid::roles.end(),
                     [&](const sysid::RoleSpec& spec) { return spec.word == word.substr(0, equals); });
}

/// Returns the option with values of the form ROLE=VALUE that is given. If several such options are given, or
/// none, returns "--scale" as an example.
std::string option_of(const ImportOptions& options) {
  std::vector<std::string> given;
  if (!options.units.empty()) given.emplace_back("--unit");
  if (!options.scales.empty()) given.emplace_back("--scale");
  if (!options.zeros.empty()) given.emplace_back("--zero");
  return given.size() == 1 ? given.front() : "--scale";
}

}  // namespace

tl::expected<void, std::string> check_files(const ImportOptions& options) {
  std::error_code error;
  for (const std::string& file : options.files) {
    if (!is_setting(file) || fs::exists(file, error)) continue;
    const std::string option = option_of(options);
    return tl::unexpected("'" + file + "' is not a file. An option such as " + option +
                          " has one value, so repeat the option for each further value: " + option + " " +
                          file);
  }
  return {};
}

tl::expected<std::vector<std::string>, std::string> import_targets(const std::vector<std::string>& files,
                                                                   const std::string& out) {
  std::error_code error;
  const bool folder = out.ends_with('/') || fs::is_directory(out, error);
  if (files.size() > 1 && !folder) {
    const auto missing = std::find_if(files.begin(), files.end(),
                                      [&](const std::string& file) { return !fs::exists(file, error); });
    if (missing != files.end())
      return tl::unexpected(
          "there is no file '" + *missing + "'. If '" + *missing +
          "' is a further value of an option such as --command, repeat the option for this value");
    return tl::unexpected("--out " + out + " must be a folder for " + std::to_string(files.size()) +
                          " files, so the name of the folder must end with a '/'");
  }
  std::vector<std::string> targets;
  std::set<std::string> seen;
  for (const std::string& file : files) {
    targets.push_back(folder ? (fs::path(out) / log_name(file)).string() : out);
    if (!seen.insert(targets.back()).second)
      return tl::unexpected("two input files would be written to the same output file " + targets.back());
  }
  return targets;
}

tl::expected<sysid::Mapping, std::string> mapping_of(const ImportOptions& options, sysid::Mapping begun) {
  sysid::Mapping mapping = std::move(begun);
  for (std::size_t i = 0; i < sysid::role_count; ++i) {
    // Unit, scale and zero of the mapping belong to the columns of the mapping, and not to other columns.
    const bool is_same = options.columns[i].empty() || options.columns[i] == mapping.columns[i].columns;
    if (!is_same) mapping.columns[i] = {options.columns[i], {}, {}, {}, false};
  }
  sysid::ColumnMapping& time = mapping[sysid::Role::time];
  const bool has_time = !options.columns[static_cast<std::size_t>(sysid::Role::time)].empty();
  if (options.rate_hz && !has_time) time = {};
  if (has_time && !options.rate_hz) mapping.rate_hz.reset();
  const auto take_unit = [](sysid::ColumnMapping& column, const std::string& text) {
    column.unit = text;
    return true;
  };
  if (auto done = apply(options.units, "--unit", "a unit", mapping, take_unit); !done)
    return tl::unexpected(done.error());
  if (auto done = apply(options.scales, "--scale", "a number other than 0", mapping, take_scale); !done)
    return tl::unexpected(done.error());
  if (auto done = apply(options.zeros, "--zero", "a number or the word first", mapping, take_zero); !done)
    return tl::unexpected(done.error());
  if (options.rate_hz) mapping.rate_hz = options.rate_hz;
  if (mapping.rate_hz && time.given())
    return tl::unexpected(std::string(
        "--time and --rate-hz cannot be given together, because a file with a time column needs no rate"));
  const auto codes = codes_of(options.missing_in);
  if (!codes) return tl::unexpected(codes.error());
  if (!options.missing.empty()) {
    mapping.missing = options.missing;
    mapping.missing_in.clear();
  }
  if (!codes->empty()) mapping.missing_in = *codes;
  for (std::string& word : mapping.missing) word = sysid::lower_case(word);
  if (!options.separator.empty()) {
    mapping.separator = sysid::separator_named(options.separator);
    if (mapping.separator == 0)
      return tl::unexpected("--separator " + options.separator + ": comma, semicolon, tab, space or bar");
  }
  if (!options.channel.empty()) mapping.channel = options.channel;
  if (!options.sheet.empty()) mapping.sheet = options.sheet;
  mapping.skip_bad_lines = mapping.skip_bad_lines || options.skip_bad_lines;
  if (options.from_s) mapping.from_s = *options.from_s;
  if (options.to_s) mapping.to_s = *options.to_s;
  if (mapping.from_s > mapping.to_s)
    return tl::unexpected("the start (from-s, " + significant(mapping.from_s) +
                          " s) is after the end (to-s, " + significant(mapping.to_s) +
                          " s); the start must be before the end");
  return mapping;
}

}  // namespace softgrip::tools
