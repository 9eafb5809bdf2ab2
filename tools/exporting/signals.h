#pragma once
// Recordings, logs and series as signals over time, on their way into other programs.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"

namespace softgrip::tools {

/// Either numbers or texts, one per sample.
struct Signal {
  std::string name;                ///< "displacement_mm", "state"
  std::vector<double> values;      ///< NaN: nothing there; empty of a text
  std::vector<std::string> texts;  ///< empty of numbers
};

/// What belongs to one finger, or all of a file without channels.
struct SignalGroup {
  std::string name;            ///< of the channel; empty: there are none
  std::vector<double> time_s;  ///< rising
  std::vector<Signal> signals;
};

/// Reads a recording's folder, a log, or another table with a column time_s (series.csv). What is refused has
/// been printed; the error is the exit code.
[[nodiscard]] tl::expected<std::vector<SignalGroup>, ExitCode> read_signals(const std::string& path);

/// All groups on one axis: every time that any of them has, and a column per signal and finger, named
/// "left_displacement_mm". Where a group has no sample there is NaN or an empty text.
[[nodiscard]] SignalGroup wide(const std::vector<SignalGroup>& groups);

/// The CSV text of a group: time_s and its signals, an empty cell where nothing is.
[[nodiscard]] std::string wide_csv(const SignalGroup& group);

}  // namespace softgrip::tools
