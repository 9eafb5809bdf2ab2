#pragma once
// Computes the times of a column of dates or times of day.

#include <optional>
#include <vector>

#include "base/time.h"
#include "sysid/import/cell_value.h"
#include "sysid/import/clock.h"

namespace softgrip::sysid {

/// Computes times relative to the first timestamp of a column. The times are whole nanoseconds, because
/// seconds since 1970 in a double would lose digits.
class TextClock {
 public:
  /// Adds the next timestamp. Returns the time since the first timestamp [s]. For a time of day, `days` is
  /// added to this time.
  /// @param days  time between the first date and the date of the row; 0: the rows have no dates.
  double add(const CellValue& cell, Nanoseconds days);

  /// Returns true if midnight is between the last two timestamps: the time of day decreased by more than half
  /// a day.
  [[nodiscard]] bool is_midnight() const { return is_midnight_; }

  /// Corrects times that begin again after midnight, or after the end of an hour if they are minutes and
  /// seconds. If the times decrease although the dates of the rows were added, the dates change in other
  /// rows than the times of day begin again. The dates are then not used. The times are not changed if they
  /// never decrease, or if neither midnight nor the end of an hour explains each decrease.
  /// @param times_s  results of add() for the rows; NaN: the row has no timestamp.
  /// @param days_s   for each row, the time between the first date and the date of the row [s]; empty: the
  /// rows have no dates.
  std::optional<Overflow> continue_times(std::vector<double>& times_s,
                                         const std::vector<double>& days_s) const;

 private:
  Nanoseconds first_ = 0;
  Nanoseconds last_ = 0;
  Nanoseconds first_days_ = 0;  ///< value of `days` for the first timestamp
  bool begun_ = false;
  bool is_midnight_ = false;
  bool has_dates_ = false;  ///< true: a timestamp has a date
  bool has_hours_ = false;  ///< true: a timestamp without a date has hours
  bool is_short_ = false;   ///< true: a timestamp has two fields
};

}  // namespace softgrip::sysid
