#pragma once
// Reads recordings, logs and series as signals over time, and writes them as CSV, MATLAB or MCAP files.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/exit_code.h"

namespace softgrip::tools {

/// A signal with one number or one text per sample.
struct Signal {
  std::string name;                ///< name of the column, for example "displacement_mm" or "state"
  std::vector<double> values;      ///< one number per sample, NaN if it is missing; empty if the signal
                                   ///< consists of texts
  std::vector<std::string> texts;  ///< one text per sample: the content of the cell in the input; empty if
                                   ///< the cells are not stored

  /// Returns true if the signal consists of texts.
  [[nodiscard]] bool is_text() const { return values.empty() && !texts.empty(); }
};

/// The signals of one finger, or all signals of a file without channels.
struct SignalGroup {
  std::string name;            ///< name of the channel; empty: the file has no channels
  std::vector<double> time_s;  ///< times of the samples [s], strictly rising
  std::vector<Signal> signals;
};

/// Reads the folder of a recording, a log, or another table with a column time_s, for example series.csv. On
/// failure, prints the reason and returns the exit code.
[[nodiscard]] tl::expected<std::vector<SignalGroup>, ExitCode> read_signals(const std::string& path);

/// Merges all groups on one time axis that contains the times of all groups. The result has one column per
/// signal and finger, for example "left_displacement_mm". A missing sample is NaN or an empty text.
[[nodiscard]] SignalGroup wide(const std::vector<SignalGroup>& groups);

/// Returns the CSV text of a group: time_s and its signals. Missing values are empty cells. Stored cells of
/// the input are written unchanged.
[[nodiscard]] std::string wide_csv(const SignalGroup& group);

/// The bytes of a .mat file, and the names of the omitted signals, whose values are texts.
struct MatBytes {
  std::string bytes;
  std::vector<std::string> left_out;
};

/// Returns a compressed file of version 5 with time_s and one column vector per numeric signal. The bytes are
/// read back and compared with the signals. Equal signals give equal bytes. On failure, returns a sentence
/// that describes the error.
[[nodiscard]] tl::expected<MatBytes, std::string> mat_bytes(const SignalGroup& group);

/// Returns `name` as a name that MATLAB accepts: at most 63 letters, digits and underscores. The first
/// character is a letter.
[[nodiscard]] std::string matlab_name(const std::string& name);

/// Returns the bytes of a file with one topic per group and one JSON object per sample. The topic is "/left"
/// for the group "left" and "/signals" for a group without a name. The keys of an object are the names of the
/// signals and time_s, which is 0 at the start of the recording. A missing value has no key. The file is
/// uncompressed, indexed by chunks of at most 4 MiB, and has checksums.
[[nodiscard]] std::string mcap_bytes(const std::vector<SignalGroup>& groups, const std::string& library);

}  // namespace softgrip::tools
