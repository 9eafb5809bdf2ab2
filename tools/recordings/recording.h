#pragma once
// A recording as it is looked at: every channel's log, and what happened meanwhile.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "document/problem.h"
#include "sysid/logs/log.h"

namespace softgrip::tools {

/// An event of run.json.
struct RecordedEvent {
  double time_s = 0;
  std::string kind;     ///< "grip_result", "fault_latched", "step_started", ...
  std::string channel;  ///< empty: of the whole rig
  std::string code;     ///< "HOLDING", "F101", ...
  std::string text;
};

struct Recording {
  std::string name;                  ///< of the folder or file
  std::string sequence;              ///< empty if unknown
  std::string software_version;      ///< that recorded it, empty if unknown
  std::string started_at;            ///< UTC, empty if unknown or in virtual time
  std::string recipe;                ///< what two runs of the same sequence, text and parameters share
  bool unfinished = false;           ///< it is still being recorded, or its daemon was killed
  std::vector<sysid::Log> channels;  ///< as LogOptions::need_readings = false reads them
  std::vector<RecordedEvent> events;
};

/// Reads a recording's folder, or a log by itself. Problems are added to `problems`; an unreadable file is
/// ExitCode::io and printed.
[[nodiscard]] tl::expected<Recording, ExitCode> read_recording(const std::string& path,
                                                               document::Problems& problems);

/// A column that the log contract does not name, as numbers: NaN where a cell is none. Empty: no such column.
[[nodiscard]] std::vector<double> numbers_of(const sysid::Log& log, const std::string& column);
/// The same as texts.
[[nodiscard]] std::vector<std::string> texts_of(const sysid::Log& log, const std::string& column);

}  // namespace softgrip::tools
