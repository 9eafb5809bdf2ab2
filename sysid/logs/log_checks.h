#pragma once
// Checks of time, excitation, sensor and units, for a log whose cells are all readable.

#include <string>
#include <string_view>
#include <vector>

#include "document/problem.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// The positions of the samples of a log in its text.
struct LogSource {
  std::string file;
  std::vector<int> line;                    ///< line number of each sample
  std::vector<std::string_view> line_text;  ///< line of each sample, without line break
  int time_column = 1;                      ///< byte column of the header cell, for messages
  int command_column = 1;
  int displacement_column = 1;
};

/// Adds a problem for each reason to refuse the log, and adds notes about other findings to the log.
void check_log(Log& log, const LogSource& source, const LogOptions& options, document::Problems& problems);

}  // namespace softgrip::sysid
