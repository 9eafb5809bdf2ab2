#pragma once
// The account of a foreign file: each of its rows is in the log, or is counted with the reason.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace softgrip::sysid {

/// Why a row is not in the log.
enum class LeftOut : std::uint8_t {
  other_channel,
  outside_stretch,
  empty,
  bad_line,
  cut_off_line,
  no_time,
  repeated_time,
  before_command,
  hole
};
inline constexpr std::size_t left_out_count = 9;

/// The word of a reason in JSON.
[[nodiscard]] std::string_view word_of(LeftOut reason);

/// Above this share of lost rows the import warns.
inline constexpr double warned_share = 0.05;
/// Above this share of lost rows the import refuses the file.
inline constexpr double refused_share = 0.8;

/// A file with two time columns has two entries in each row; each entry counts as a row.
struct RowAccount {
  std::size_t rows = 0;    ///< of the file
  std::size_t used = 0;    ///< samples of the log
  std::size_t joined = 0;  ///< rows that complete the sample of another row at the same time
  std::array<std::size_t, left_out_count> left_out{};

  void leave_out(LeftOut reason, std::size_t count = 1) {
    left_out[static_cast<std::size_t>(reason)] += count;
  }
  /// True if no row is without a fate.
  [[nodiscard]] bool balanced() const;
  /// Rows that nobody asked to leave out, and their share of the rows that the user asked for.
  [[nodiscard]] std::size_t lost() const;
  [[nodiscard]] double lost_share() const;
  /// "1500 rows: 600 used, 900 left out (900 at the time of the row before)".
  [[nodiscard]] std::string sentence() const;
};

}  // namespace softgrip::sysid
