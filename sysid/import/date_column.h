#pragma once
// Follows the dates in a column that has dates without a time of day. Another column has the time of day.

#include <optional>
#include <string>
#include <string_view>

#include "base/time.h"

namespace softgrip::sysid {

/// A column of dates that belongs to a column of times of day in the same rows.
class DateColumn {
 public:
  /// Returns true if the name of a column is that of a date: "Date" or "Datum".
  [[nodiscard]] static bool has_name(std::string_view column);

  /// Reads the date of the next row.
  /// @param text  content of the cell; empty: the date of the previous row still applies.
  void read(std::string_view text);

  /// Returns true if the current date can be read.
  [[nodiscard]] bool is_readable() const { return day_.has_value(); }
  /// Returns the time between the first date and the current date.
  [[nodiscard]] Nanoseconds since_first() const { return since_first_; }
  [[nodiscard]] const std::string& text() const { return text_; }  ///< current date as written in the file
  /// Returns true once after each change of the date if the number of days between the two dates is unknown.
  [[nodiscard]] bool take_unread_change();

 private:
  std::string text_;
  std::optional<Nanoseconds> day_;
  Nanoseconds since_first_ = 0;
  bool has_unread_change_ = false;
};

}  // namespace softgrip::sysid
