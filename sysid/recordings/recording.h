#pragma once
// A recording for display: the log of every channel, and the events.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "document/problem.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// An event of run.json.
struct RecordedEvent {
  double time_s = 0;
  std::string kind;     ///< "grip_result", "fault_latched", "step_started", ...
  std::string channel;  ///< empty: the whole rig
  std::string code;     ///< "HOLDING", "F101", ...
  std::string text;
};

struct Recording {
  std::string name;              ///< name of the folder or file
  std::string sequence;          ///< empty if unknown
  std::string software_version;  ///< software that recorded it; empty if unknown
  std::string started_at;        ///< UTC, empty if unknown or in virtual time
  std::string recipe;            ///< equal for two runs of the same sequence, text and parameters
  bool unfinished = false;       ///< the recording continues, or its daemon was killed
  std::vector<Log> channels;     ///< as read with LogOptions::need_readings = false
  std::vector<RecordedEvent> events;
};

/// Reads a recording's folder, or a log by itself. The error is a sentence if a file cannot be opened. It is
/// empty if the log has problems, which are all added to `problems`.
[[nodiscard]] tl::expected<Recording, std::string> read_recording(const std::string& path,
                                                                  document::Problems& problems);

/// Returns a column outside the log contract as numbers. A cell that is not a number is NaN. Empty: no such
/// column.
[[nodiscard]] std::vector<double> numbers_of(const Log& log, const std::string& column);
/// Returns a column outside the log contract as texts.
[[nodiscard]] std::vector<std::string> texts_of(const Log& log, const std::string& column);

}  // namespace softgrip::sysid
