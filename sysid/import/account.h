#pragma once
// Row counts of an imported file: each row is either used in the log or counted with the reason for which it
// is left out.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace softgrip::sysid {

/// The reason why a row is not in the log.
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

/// Share of lost rows above which the import warns.
inline constexpr double warned_share = 0.05;
/// Share of lost rows above which the import refuses the file.
inline constexpr double refused_share = 0.8;

/// Numbers of rows. If a file has two time columns, each row counts twice, once per time.
struct RowAccount {
  std::size_t rows = 0;    ///< all rows of the file
  std::size_t used = 0;    ///< rows that became samples of the log
  std::size_t joined = 0;  ///< rows whose values were added to the sample of another row at the same time
  std::array<std::size_t, left_out_count> left_out{};

  void leave_out(LeftOut reason, std::size_t count = 1) {
    left_out[static_cast<std::size_t>(reason)] += count;
  }
  /// Returns true if each row is used, joined or left out.
  [[nodiscard]] bool balanced() const;
  /// Returns the number of rows that were left out for a reason that the user did not request.
  [[nodiscard]] std::size_t lost() const;
  /// Returns lost() divided by the number of rows that the user did not exclude.
  [[nodiscard]] double lost_share() const;
  /// Returns, for example, "1500 rows: 600 used, 900 left out (900 at the time of the row before)".
  [[nodiscard]] std::string sentence() const;
};

}  // namespace softgrip::sysid
