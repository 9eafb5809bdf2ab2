#pragma once
// The first line of a log.

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/logs/log.h"
#include "sysid/logs/log_columns.h"
#include "sysid/logs/log_reporter.h"

namespace softgrip::sysid {

/// Where the columns of a log stand in its rows.
struct LogHeader {
  std::vector<std::string> names;
  std::array<int, known_columns.size()> index{};  ///< -1: absent
  std::array<int, known_columns.size()> column{};
  int channel = -1;
  ReadingColumn reading = reading_columns.front();  ///< which of them holds the readings
};

/// What is wrong with it is reported; then the header is not to be used.
[[nodiscard]] LogHeader read_header(std::string_view line, const LogOptions& options, LogReporter& report);

}  // namespace softgrip::sysid
