#pragma once
// Checks time, excitation, sensor and units of a log whose cells were all read without errors.

#include <string>
#include <string_view>
#include <vector>

#include "document/problem.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// The positions of a log's samples in its text.
struct LogSource {
  std::string file;
  std::vector<int> line;                    ///< line number of each sample
  std::vector<std::string_view> line_text;  ///< line of each sample, without line break
  /// Column of the time in the header line, counted in bytes, for messages.
  int time_column = 1;
  int command_column = 1;
  int displacement_column = 1;
};

/// Adds a problem for each reason to refuse the log. Other findings are added to the log as notes.
void check_log(Log& log, const LogSource& source, const LogOptions& options, document::Problems& problems);

}  // namespace softgrip::sysid
