#pragma once
// Options and readers of logs for the commands that analyse logs.

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

/// Options for the interpretation of the logs of a command.
struct LogInput {
  std::string channel;
  std::string drive = "command";
  std::string begin = "auto";
  bool held = false;
  /// True: if the pressure is measured, the reader adds no first sample to a log that begins when its command
  /// is set (sysid/logs/command_before.h), because a separate model of the pressure begins at the measured
  /// value.
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
/// Returns mm, the unit of rigs.
[[nodiscard]] RequiredUnit unit_of_rigs();

/// Reads all logs. If one is refused, prints all problems and returns the exit code. Without a required unit,
/// all logs must have the unit of the first log.
[[nodiscard]] tl::expected<std::vector<sysid::Log>, ExitCode> read_logs(
    const std::vector<std::string>& paths, const LogInput& input,
    const std::optional<RequiredUnit>& required = {});

/// Prints the problems of logs, and for each file a hint how `softgrip import` can convert it. Returns
/// ExitCode::input_refused.
ExitCode refuse_logs(const document::Problems& problems);

/// Reads a gauge file. If it is refused, prints all problems and returns the exit code. A file whose unit
/// differs from the required unit is refused.
[[nodiscard]] tl::expected<sysid::GaugeFile, ExitCode> read_gauge(const std::string& path,
                                                                  const RequiredUnit& required);

}  // namespace softgrip::tools
