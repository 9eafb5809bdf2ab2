#pragma once
// Declares the options and the readers of logs for the commands that analyse logs.

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

/// Options that define how the logs of a command are read.
struct LogInput {
  std::string channel;
  std::string drive = "command";
  std::string begin = "auto";
  bool held = false;
  /// True: a log with measured pressure gets no additional first sample, even if the log begins at the moment
  /// at which its first command is set (sysid/logs/command_before.h). A separate model of the pressure then
  /// begins at the measured value.
  bool begins_at_measured_pressure = false;

  [[nodiscard]] sysid::RecordOptions record_options() const;
};

/// Adds --channel, --drive, --begin and --held to a command.
void add_log_options(CLI::App& command, LogInput& input);

/// The unit that the readings of logs must have, and the origin of this requirement.
struct RequiredUnit {
  std::string of;  ///< origin of the requirement, for example "the model given"
  model::OutputUnit unit = model::OutputUnit::mm;
};
[[nodiscard]] RequiredUnit unit_of(const model::Model& model);
[[nodiscard]] RequiredUnit unit_of(const std::vector<sysid::Log>& logs);
/// Returns mm as the required unit, because rigs use mm.
[[nodiscard]] RequiredUnit unit_of_rigs();

/// Reads all logs. If a log is refused, prints all problems and returns the exit code. If no unit is
/// required, all logs must have the unit of the first log.
[[nodiscard]] tl::expected<std::vector<sysid::Log>, ExitCode> read_logs(
    const std::vector<std::string>& paths, const LogInput& input,
    const std::optional<RequiredUnit>& required = {});

/// Prints the problems of logs. For each file, also prints a hint if `softgrip import` can convert the file.
/// Returns ExitCode::input_refused.
ExitCode refuse_logs(const document::Problems& problems);

/// Reads a gauge file. Refuses a file whose unit differs from the required unit. On failure, prints all
/// problems and returns the exit code.
[[nodiscard]] tl::expected<sysid::GaugeFile, ExitCode> read_gauge(const std::string& path,
                                                                  const RequiredUnit& required);

/// Returns a sentence with the command line of `softgrip import` that converts the file, and a line break. If
/// the import needs more information, the command shows the columns of the file or selects one of its sheets.
/// Returns an empty text if the file has the columns of a log, or if the import would refuse the file as
/// well.
[[nodiscard]] std::string import_hint(const std::string& path);

}  // namespace softgrip::tools
