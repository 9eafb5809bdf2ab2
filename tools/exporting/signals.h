#pragma once
// Reads recordings, logs and series as signals over time, for the export.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"

namespace softgrip::tools {

/// Numbers or texts, one per sample.
struct Signal {
  std::string name;                ///< "displacement_mm", "state"
  std::vector<double> values;      ///< NaN: missing; empty for texts
  std::vector<std::string> texts;  ///< empty for numbers
};

/// The signals of one finger, or all signals of a file without channels.
struct SignalGroup {
  std::string name;            ///< name of the channel; empty: there are no channels
  std::vector<double> time_s;  ///< rising
  std::vector<Signal> signals;
};

/// Reads a recording's folder, a log, or another table with a column time_s (series.csv). On failure, prints
/// the reason and returns the exit code.
[[nodiscard]] tl::expected<std::vector<SignalGroup>, ExitCode> read_signals(const std::string& path);

/// Merges all groups on one time axis that contains every time of any group. The result has one column per
/// signal and finger, named "left_displacement_mm". Missing samples are NaN or an empty text.
[[nodiscard]] SignalGroup wide(const std::vector<SignalGroup>& groups);

/// Returns the CSV text of a group: time_s and its signals. Missing values are empty cells.
[[nodiscard]] std::string wide_csv(const SignalGroup& group);

}  // namespace softgrip::tools
