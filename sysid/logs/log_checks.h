#pragma once
// Checks of a log whose cells are all readable: time, excitation, sensor, units.

#include <string>
#include <string_view>
#include <vector>

#include "document/problem.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// The places of the samples of a log in its text.
struct LogSource {
  std::string file;
  std::vector<int> line;                    ///< of each sample
  std::vector<std::string_view> line_text;  ///< of each sample, without line break
  int time_column = 1;                      ///< byte column of the header's cell, for messages
  int command_column = 1;
  int displacement_column = 1;
};

/// Adds problems for what must be refused, and notes to the log for what is only worth knowing.
void check_log(Log& log, const LogSource& source, const LogOptions& options, document::Problems& problems);

}  // namespace softgrip::sysid
