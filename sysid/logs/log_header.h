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

/// The places of the columns of a log in its rows.
struct LogHeader {
  std::vector<std::string> names;
  std::array<int, known_columns.size()> index{};  ///< -1: absent
  std::array<int, known_columns.size()> column{};
  int channel = -1;
  ReadingColumn reading = reading_columns.front();  ///< which of them holds the readings
};

/// Reads the header. Reports its errors; after an error, the header must not be used.
[[nodiscard]] LogHeader read_header(std::string_view line, const LogOptions& options, LogReporter& report);

}  // namespace softgrip::sysid
