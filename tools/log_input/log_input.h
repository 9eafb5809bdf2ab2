#pragma once
// Reading logs as the desk's commands take them.

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"
#include "document/problem.h"
#include "model/model.h"
#include "sysid/diagnosis/gauge/gauge_file.h"
#include "sysid/logs/log.h"
#include "sysid/logs/record.h"

namespace CLI {
class App;
}

namespace softgrip::tools {

/// How the logs of a command are to be understood.
struct LogInput {
  std::string channel;
  std::string drive = "command";
  std::string begin = "auto";
  bool held = false;
  /// A log that begins as its command was set gets a sample before it (sysid/logs/command_before.h). True:
  /// not if its pressure is measured, because a stage of its own begins at that pressure.
  bool begins_at_measured_pressure = false;

  [[nodiscard]] sysid::RecordOptions record_options() const;
};

/// Adds --channel, --drive, --begin and --held to a command.
void add_log_options(CLI::App& command, LogInput& input);

/// The unit that the readings of logs must have, and its origin.
struct RequiredUnit {
  std::string of;  ///< "the model given"
  model::OutputUnit unit = model::OutputUnit::mm;
};
[[nodiscard]] RequiredUnit unit_of(const model::Model& model);
[[nodiscard]] RequiredUnit unit_of(const std::vector<sysid::Log>& logs);
/// A rig measures in mm, and what is said of rigs is in mm.
[[nodiscard]] RequiredUnit unit_of_rigs();

/// Reads all logs; where one is refused, prints all problems and returns the exit code. Without a required
/// unit, all must be in that of the first.
[[nodiscard]] tl::expected<std::vector<sysid::Log>, ExitCode> read_logs(
    const std::vector<std::string>& paths, const LogInput& input,
    const std::optional<RequiredUnit>& required = {});

/// Prints the problems of logs and, of each file, how `softgrip import` would make a log of it. Returns
/// ExitCode::input_refused.
ExitCode refuse_logs(const document::Problems& problems);

/// Reads a gauge file; where it is refused, prints all problems and returns the exit code. One in another
/// unit is refused.
[[nodiscard]] tl::expected<sysid::GaugeFile, ExitCode> read_gauge(const std::string& path,
                                                                  const RequiredUnit& required);

}  // namespace softgrip::tools
