#pragma once
// Reads the first line of a log.
// Checks the times, the excitation, the sensor and the units of a log. The checks begin after all cells of
// the log were read without errors.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "document/problem.h"
#include "sysid/logs/log.h"
#include "sysid/logs/log_columns.h"

namespace softgrip::sysid {

/// Position of each column of the log format in the rows of a log.
struct LogHeader {
  std::vector<std::string> names;
  /// Index of the cell in each row; -1: the log has no such column.
  std::array<int, known_columns.size()> index{};
  std::array<int, known_columns.size()> column{};
  int channel = -1;
  ReadingColumn reading = reading_columns.front();  ///< column that contains the readings
};

/// Reads the header line and reports its errors. If an error was reported, the caller must not use the
/// result.
[[nodiscard]] LogHeader read_header(std::string_view line, const LogOptions& options, LogReporter& report);

/// Positions of the samples of a log in its text.
struct LogSource {
  std::string file;
  std::vector<int> line;                    ///< for each sample, its line number in the text
  std::vector<std::string_view> line_text;  ///< text line for each sample, without its line break
  /// Position of the time column in the header line, counted in bytes, for messages.
  int time_column = 1;
  int command_column = 1;
  int displacement_column = 1;
};

/// Checks a log. Adds a problem to `problems` for each reason to refuse the log, and adds all other findings
/// to the log as notes.
void check_log(Log& log, const LogSource& source, const LogOptions& options, document::Problems& problems);

}  // namespace softgrip::sysid
