#pragma once
// Rows of run.csv, as fast as numbers can be written.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/loop/shared_state.h"

namespace softgrip::daemon {

/// Longest text that write_decimal() makes.
inline constexpr std::size_t longest_decimal = 32;

/// Writes a number with six decimals at most, trailing zeros left out, and returns the end. A nanometre or a
/// millipascal is far below what any sensor of a rig resolves, and this costs a quarter of a shortest
/// round-trip text. Not finite: nothing is written. Beyond a million million: shortest round-trip form.
[[nodiscard]] char* write_decimal(char* to, double value) noexcept;

/// Writes nanoseconds as seconds, exactly, trailing zeros left out.
[[nodiscard]] char* write_seconds(char* to, Nanoseconds duration) noexcept;

/// The rows of one recording. Columns: see docs/reference/recording.md.
class CsvRows {
 public:
  /// `with_pressure`: some channel measures its pressure, so there is a column for it; `with_temperature`
  /// likewise.
  CsvRows(std::vector<std::string> channel_names, bool with_pressure, bool with_temperature = false);

  [[nodiscard]] std::string header() const;
  /// Appends a row; `begin` is the recording's time 0.
  void append(std::string& text, const Record& record, Nanoseconds begin) const;

 private:
  std::vector<std::string> channel_names_;
  std::size_t longest_name_ = 0;
  bool with_pressure_, with_temperature_;
};

/// "valid", "none_yet", ... as the column `validity` has them.
[[nodiscard]] std::string_view name_of(model::Validity validity) noexcept;

}  // namespace softgrip::daemon
