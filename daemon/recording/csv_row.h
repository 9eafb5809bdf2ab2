#pragma once
// Writes rows of run.csv with little computing time per row.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/loop/shared_state.h"

namespace softgrip::daemon {

/// Length of the longest text that write_decimal() writes [bytes].
inline constexpr std::size_t longest_decimal = 32;

/// Writes a number with at most six decimals and without trailing zeros, and returns the end of the text. Six
/// decimals are sufficient: a nanometre or a millipascal is far below the resolution of any sensor of a rig.
/// An exact text, from which the same double can be read, would take four times as long to write. A number
/// whose magnitude is 9e12 or more is written as such an exact text. For a number that is not finite, writes
/// nothing.
[[nodiscard]] char* write_decimal(char* to, double value) noexcept;

/// Writes a number of nanoseconds in seconds. The text is exact and has no trailing zeros.
[[nodiscard]] char* write_seconds(char* to, Nanoseconds duration) noexcept;

/// Writes the rows of one recording. docs/reference/recording.md describes the columns.
class CsvRows {
 public:
  /// If `with_pressure` is true, the rows have the column of the measured pressure, for rigs that measure the
  /// pressure. If `with_temperature` is true, they have the column of the temperature.
  CsvRows(std::vector<std::string> channel_names, bool with_pressure, bool with_temperature = false);

  [[nodiscard]] std::string header() const;
  /// Appends a row to `text`. `begin` is time 0 of the recording.
  void append(std::string& text, const Record& record, Nanoseconds begin) const;

 private:
  std::vector<std::string> channel_names_;
  std::size_t longest_name_ = 0;
  bool with_pressure_, with_temperature_;
};

/// Returns the text for a validity in the column `validity`: "valid", "none_yet", ...
[[nodiscard]] std::string_view name_of(model::Validity validity) noexcept;

}  // namespace softgrip::daemon
