#pragma once
// Reads a recording: the log of every channel, and the events.

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
  std::string channel;  ///< empty: the event concerns the whole rig
  std::string code;     ///< "HOLDING", "F101", ...
  std::string text;
};

struct Recording {
  std::string name;              ///< name of the folder or file
  std::string sequence;          ///< empty if unknown
  std::string software_version;  ///< version of the software that recorded it; empty if unknown
  std::string started_at;        ///< UTC, empty if unknown or in virtual time
  /// Equal for two recordings if sequence, text of the sequence and parameters are equal.
  std::string recipe;
  /// The recording is not complete: it is still being written, or its daemon was killed.
  bool unfinished = false;
  std::vector<Log> channels;  ///< one log per channel; displacement readings may be missing
  std::vector<RecordedEvent> events;
};

/// Reads the folder of a recording, or a single log file. The error is a sentence if a file cannot be opened.
/// It is empty if the log has problems, which are all added to `problems`.
[[nodiscard]] tl::expected<Recording, std::string> read_recording(const std::string& path,
                                                                  document::Problems& problems);

/// Returns the numbers of a column that does not belong to the log format. A cell that is not a number is
/// NaN. The result is empty if there is no such column.
[[nodiscard]] std::vector<double> numbers_of(const Log& log, const std::string& column);
/// Returns the texts of a column that does not belong to the log format. The result is empty if there is no
/// such column.
[[nodiscard]] std::vector<std::string> texts_of(const Log& log, const std::string& column);

}  // namespace softgrip::sysid
