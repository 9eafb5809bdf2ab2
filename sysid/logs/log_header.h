#pragma once
// Reader of the first line of a log.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/logs/log.h"
#include "sysid/logs/log_columns.h"
#include "sysid/logs/log_reporter.h"

namespace softgrip::sysid {

/// The positions of the columns in the rows of a log.
struct LogHeader {
  std::vector<std::string> names;
  std::array<int, known_columns.size()> index{};  ///< -1: absent
  std::array<int, known_columns.size()> column{};
  int channel = -1;
  ReadingColumn reading = reading_columns.front();  ///< the column that contains the readings
};

/// Reads the header and reports its errors. If there was an error, the result must not be used.
[[nodiscard]] LogHeader read_header(std::string_view line, const LogOptions& options, LogReporter& report);

}  // namespace softgrip::sysid
