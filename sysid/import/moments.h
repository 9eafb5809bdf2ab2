#pragma once
// Parses dates and times of day in the formats that people and data loggers write. Follows the dates in a
// column that has dates without a time of day, if another column has the time of day. Combines a time that is
// split into two columns, whole seconds and remaining nanoseconds, as in a ROS message header.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/time.h"
#include "sysid/import/table.h"

namespace softgrip::sysid {

/// A date with a time of day, or a time of day alone. The origin of the time depends on the text, so only the
/// difference of two times with the same origin is meaningful.
struct Moment {
  /// Time since 1970 in UTC if the text has a date, otherwise time since midnight.
  Nanoseconds time = 0;
  bool dated = false;  ///< true: the text has a date; false: the text has a time of day only
  /// True: the text has two fields ("12:34"), which were read as minutes and seconds.
  bool short_clock = false;
  /// True: the text has two fields, which cannot be hours and minutes, because the first field exceeds 23 or
  /// the text has a fraction.
  bool surely_minutes = false;
};

/// Parses a date with a time of day, or a time of day. Accepted are ISO 8601 (2024-05-31T12:00:00.25+02:00,
/// also with a blank instead of T and with a decimal comma), 31.05.2024 12:00:00, 2024/05/31 12:00:00,
/// 31-May-2024 12:00:00, May 31, 2024 12:00:00, and a time of day alone (12:00:00.25, 12:00:00:250,
/// 12:00:00 PM). Two fields alone are minutes and seconds (00:59.5). 05/31/2024 is not accepted, because the
/// order of day and month is ambiguous.
[[nodiscard]] std::optional<Moment> moment_of(std::string_view text);

/// Parses a date without a time of day, in the formats of moment_of(), or a date with the time 00:00:00.
/// Returns the start of this day, as time since 1970.
[[nodiscard]] std::optional<Nanoseconds> day_of(std::string_view text);

/// Returns the note that two columns are combined into one time.
[[nodiscard]] std::string about_combined_times(const TableColumn& first, const TableColumn& second);

/// Returns the note that a column of dates is not used, because its dates contradict the times of day.
[[nodiscard]] std::string about_unused_dates(const TableColumn& dates, const TableColumn& times);

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

/// Adds the nanoseconds of one column to the seconds of another column if the column names differ only in
/// their last word: "stamp.sec" and "stamp.nanosec", or "secs" and "nsecs". Both columns must contain whole
/// numbers, and the nanoseconds must be from 0 to below 1e9. The column of the nanoseconds is marked as part
/// of a time (TableColumn::is_part_of_time). A note is added to `notes` for each pair of combined columns.
void combine_split_times(std::vector<TableColumn>& columns, std::vector<std::string>& notes);

}  // namespace softgrip::sysid
