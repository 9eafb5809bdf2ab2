#pragma once
// Reads the first line of a log.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/logs/log.h"
#include "sysid/logs/log_columns.h"
#include "sysid/logs/log_reporter.h"

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

}  // namespace softgrip::sysid
