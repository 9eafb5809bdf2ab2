#include "tools/exporting/signals.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>

#include "base/numbers.h"
#include "document/problem.h"
#include "sysid/import/table_readers.h"
#include "sysid/logs/csv_text.h"
#include "sysid/logs/log_columns.h"
#include "sysid/recordings/recording.h"
#include "tools/command_line/command.h"
#include "tools/log_input/log_input.h"

namespace softgrip::tools {
namespace {

constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

/// Returns true if a cell is a whole number that a double does not represent with all its digits: more than
/// 15 digits, or a leading zero.
bool loses_digits(std::string_view cell) {
  constexpr std::size_t most_digits = 15;
  if (cell.starts_with('-') || cell.starts_with('+')) cell.remove_prefix(1);
  const bool is_whole = cell.find_first_not_of("0123456789") == std::string_view::npos;
  return is_whole && (cell.size() > most_digits || (cell.size() > 1 && cell.front() == '0'));
}

/// Converts a column to numbers if each cell is a number without loss of digits, or empty. Otherwise converts
/// it to texts.
Signal signal_of(const sysid::OtherColumn& column) {
  Signal signal{column.name, {}, column.cells};
  for (const std::string& cell : column.cells) {
    const auto number = to_number(cell);
    if ((!number && !cell.empty()) || loses_digits(cell)) return {column.name, {}, column.cells};
    signal.values.push_back(number.value_or(nothing));
  }
  return signal;
}

SignalGroup group_of(const sysid::Log& log) {
  SignalGroup group{log.channel, log.time_s, {}};
  for (const sysid::KnownColumn& known : sysid::known_columns) {
    const std::vector<double>& values = log.*known.values;
    if (&known != &sysid::known_columns[sysid::column_time] && !values.empty())
      group.signals.push_back({std::string(sysid::column_name(known, log)), values, {}});
  }
  for (const sysid::OtherColumn& other : log.others) group.signals.push_back(signal_of(other));
  return group;
}

/// Converts a table that is not a log to groups of signals. Returns an empty list if the table has no column
/// time_s.
std::vector<SignalGroup> groups_of(const sysid::ForeignTable& table) {
  const std::size_t time = sysid::column_index(table, "time_s");
  if (time == table.columns.size()) return {};
  SignalGroup group{{}, table.columns[time].values, {}};
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (i != time) group.signals.push_back({sysid::word_of(table, i), table.columns[i].values, {}});
  }
  return {group};
}

/// Returns true if a column contains numbers of which a double does not represent each digit before the
/// point.
bool may_be_rounded(const sysid::TableColumn& column) {
  constexpr double largest_exact = 9007199254740992;  // 2^53
  return std::any_of(column.values.begin(), column.values.end(),
                     [](double value) { return std::abs(value) > largest_exact; });
}

bool rises(const std::vector<double>& time_s) {
  return std::adjacent_find(time_s.begin(), time_s.end(), [](double a, double b) { return !(b > a); }) ==
         time_s.end();
}

}  // namespace

tl::expected<std::vector<SignalGroup>, ExitCode> read_signals(const std::string& path) {
  document::Problems problems;
  bool unreadable = false;
  const auto table = sysid::read_foreign_file(path, {}, problems, unreadable);
  if (!table) {
    const ExitCode refused = refuse(problems);
    return tl::unexpected(unreadable ? ExitCode::io : refused);
  }
  std::vector<SignalGroup> groups;
  if (table->is_text && sysid::column_index(*table, "pressure_command_kpa") < table->columns.size()) {
    const auto recording = sysid::read_recording(path, problems);
    if (!recording)
      return tl::unexpected(problems.empty() ? fail(ExitCode::io, recording.error()) : refuse_logs(problems));
    for (const sysid::Log& log : recording->channels) groups.push_back(group_of(log));
    return groups;
  }
  for (const sysid::TableColumn& column : table->columns) {
    if (column.bad.empty()) continue;
    const sysid::BadCell& cell = column.bad.front();
    problems.add({path, cell.at, cell.line_text,
                  "'" + document::shown(cell.text, 40) + "' in column '" + document::shown(column.name, 40) +
                      "' is not a number",
                  "softgrip export copies texts only from recordings and logs; softgrip import converts the "
                  "file to a log"});
  }
  if (!problems.empty()) return tl::unexpected(refuse(problems));
  for (const std::string& warning : table->warnings)
    std::fprintf(stderr, "softgrip: %s: %s\n", path.c_str(), warning.c_str());
  for (const sysid::TableColumn& column : table->columns) {
    if (may_be_rounded(column))
      std::fprintf(
          stderr,
          "softgrip: %s: numbers above 9007199254740992 in column '%s' may be rounded. softgrip export "
          "copies all digits only from logs with a column pressure_command_kpa\n",
          path.c_str(), document::shown(column.name, 40).c_str());
  }
  groups = groups_of(*table);
  if (!groups.empty() && rises(groups.front().time_s)) return groups;
  problems.add({path,
                {1, 1},
                {},
                "the file has no column 'time_s' with rising times, so it is not a log or a series",
                "softgrip import converts the file to a log"});
  return tl::unexpected(refuse(problems));
}

SignalGroup wide(const std::vector<SignalGroup>& groups) {
  SignalGroup all;
  for (const SignalGroup& group : groups)
    all.time_s.insert(all.time_s.end(), group.time_s.begin(), group.time_s.end());
  std::sort(all.time_s.begin(), all.time_s.end());
  all.time_s.erase(std::unique(all.time_s.begin(), all.time_s.end()), all.time_s.end());
  for (const SignalGroup& group : groups) {
    std::vector<std::size_t> row;
    for (const double time : group.time_s)
      row.push_back(static_cast<std::size_t>(std::lower_bound(all.time_s.begin(), all.time_s.end(), time) -
                                             all.time_s.begin()));
    for (const Signal& signal : group.signals) {
      Signal spread{group.name.empty() ? signal.name : group.name + "_" + signal.name, {}, {}};
      if (!signal.is_text()) spread.values.assign(all.time_s.size(), nothing);
      if (!signal.texts.empty()) spread.texts.resize(all.time_s.size());
      for (std::size_t i = 0; i < row.size(); ++i) {
        if (!signal.is_text()) spread.values[row[i]] = signal.values[i];
        if (!signal.texts.empty()) spread.texts[row[i]] = signal.texts[i];
      }
      all.signals.push_back(std::move(spread));
    }
  }
  return all;
}

std::string wide_csv(const SignalGroup& group) {
  std::string text = "time_s";
  for (const Signal& signal : group.signals) text += ',' + sysid::as_cell(signal.name);
  text += '\n';
  for (std::size_t i = 0; i < group.time_s.size(); ++i) {
    text += shortest(group.time_s[i]);
    for (const Signal& signal : group.signals) {
      text += ',';
      if (!signal.texts.empty()) {
        text += sysid::as_cell(signal.texts[i]);
      } else if (std::isfinite(signal.values[i])) {
        text += shortest(signal.values[i]);
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace softgrip::tools
