#pragma once
// Counts the rows of an imported file. Each row is either used in the log, or counted with the reason for
// which it is left out.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace softgrip::sysid {

/// Reason for which a row is left out of the log.
enum class LeftOut : std::uint8_t {
  other_channel,
  outside_stretch,
  empty,
  comment,
  bad_line,
  cut_off_line,
  no_time,
  repeated_time,
  before_command,
  hole
};
inline constexpr std::size_t left_out_count = 10;

/// Returns the identifier of a reason in the JSON output.
[[nodiscard]] std::string_view word_of(LeftOut reason);

/// Share of lost rows above which the import adds a warning.
inline constexpr double warned_share = 0.05;
/// Share of lost rows above which the import refuses the file.
inline constexpr double refused_share = 0.8;

/// Row counts of an imported file. If the file has several time columns, each row is counted once per time
/// column.
struct RowAccount {
  std::size_t rows = 0;  ///< number of all rows of the file
  std::size_t used = 0;  ///< number of rows that became samples of the log
  /// Number of rows that were merged with another row of the same time into one sample.
  std::size_t joined = 0;
  std::array<std::size_t, left_out_count> left_out{};

  void leave_out(LeftOut reason, std::size_t count = 1) {
    left_out[static_cast<std::size_t>(reason)] += count;
  }
  /// Returns true if the numbers of used rows, rows merged with another row, and left-out rows add up to the
  /// number of all rows.
  [[nodiscard]] bool balanced() const;
  /// Returns the number of lost rows: all left-out rows except empty rows and rows that the user excluded.
  [[nodiscard]] std::size_t lost() const;
  /// Returns the share of lost rows. Empty rows and rows that the user excluded are not part of the total.
  [[nodiscard]] double lost_share() const;
  /// Returns the counts as a sentence, for example "1500 rows: 600 used, 900 left out (900 with the time of
  /// the previous row)".
  [[nodiscard]] std::string sentence() const;
};

}  // namespace softgrip::sysid
