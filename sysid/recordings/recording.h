#pragma once
// Reads a recording: the log of every channel, and the events of the run.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "document/problem.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// An event that run.json contains.
struct RecordedEvent {
  double time_s = 0;
  std::string kind;     ///< kind of the event: "grip_result", "fault_latched", "step_started", ...
  std::string channel;  ///< channel that the event concerns; empty: the whole rig
  std::string code;     ///< code of the event: "HOLDING", "F101", ...
  std::string text;
};

struct Recording {
  std::string name;              ///< name of the recording's folder or file
  std::string sequence;          ///< name of the sequence; empty if unknown
  std::string software_version;  ///< version of the software that made the recording; empty if unknown
  std::string started_at;        ///< start time in UTC; empty if unknown or if the run had virtual time
  /// Text of the sequence's name, hash and parameters. Two recordings with the same recipe are comparable.
  std::string recipe;
  /// True if the recording is incomplete: it is still being written, or its daemon was killed.
  bool unfinished = false;
  std::vector<Log> channels;  ///< one log per channel; readings of the displacement may be missing
  std::vector<RecordedEvent> events;
};

/// Reads the folder of a recording, or a single log file. If the log file cannot be read, the returned error
/// is a sentence. If a log cannot be parsed, the returned error is empty, and `problems` contains the
/// reasons. An unreadable run.json is ignored.
[[nodiscard]] tl::expected<Recording, std::string> read_recording(const std::string& path,
                                                                  document::Problems& problems);

/// Returns the data of run.json in the folder of a recording, without channels. If `path` is a log file or
/// run.json is unreadable, only `name` is set.
[[nodiscard]] Recording read_recording_data(const std::string& path);

/// Returns the numbers in a column that is not part of the log format. A cell without a number gives NaN. The
/// result is empty if the log does not have this column.
[[nodiscard]] std::vector<double> numbers_of(const Log& log, const std::string& column);
/// Returns the texts in a column that is not part of the log format. The result is empty if the log does not
/// have this column.
[[nodiscard]] std::vector<std::string> texts_of(const Log& log, const std::string& column);

}  // namespace softgrip::sysid
