#pragma once
// Checks the times, the excitation, the sensor and the units of a log. The checks begin after all cells of
// the log were read without errors.

#include <string>
#include <string_view>
#include <vector>

#include "document/problem.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

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
