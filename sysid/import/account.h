#pragma once
// Row counts of an imported file: each row is in the log, or is counted with the reason why it is not.

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

/// Returns the identifier of a reason in JSON.
[[nodiscard]] std::string_view word_of(LeftOut reason);

/// If a larger share of the rows is lost, the import warns.
inline constexpr double warned_share = 0.05;
/// If a larger share of the rows is lost, the import refuses the file.
inline constexpr double refused_share = 0.8;

/// A file with two time columns has two entries in each row; each entry counts as a row.
struct RowAccount {
  std::size_t rows = 0;    ///< rows of the file
  std::size_t used = 0;    ///< samples of the log
  std::size_t joined = 0;  ///< rows that complete the sample of another row at the same time
  std::array<std::size_t, left_out_count> left_out{};

  void leave_out(LeftOut reason, std::size_t count = 1) {
    left_out[static_cast<std::size_t>(reason)] += count;
  }
  /// Returns true if each row is used, joined or left out.
  [[nodiscard]] bool balanced() const;
  /// Returns the number of rows that were left out although the user did not request it.
  [[nodiscard]] std::size_t lost() const;
  /// Returns lost() divided by the number of rows that the user requested.
  [[nodiscard]] double lost_share() const;
  /// Returns, for example, "1500 rows: 600 used, 900 left out (900 at the time of the row before)".
  [[nodiscard]] std::string sentence() const;
};

}  // namespace softgrip::sysid
