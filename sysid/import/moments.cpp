#include "sysid/import/moments.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "document/problem.h"
#include "sysid/import/units.h"

namespace softgrip::sysid {
namespace {

/// Reads the parts of a text from left to right.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : left_(text) {}

  /// Reads `fewest` to `most` digits as a number. Returns false if there are fewer digits.
  bool digits(std::size_t fewest, std::size_t most, std::int64_t& value) {
    std::size_t count = 0;
    value = 0;
    while (count < most && count < left_.size() &&
           std::isdigit(static_cast<unsigned char>(left_[count])) != 0)
      value = 10 * value + (left_[count++] - '0');
    left_.remove_prefix(count);
    return count >= fewest;
  }
  bool mark(std::string_view any) {
    if (left_.empty() || any.find(left_.front()) == std::string_view::npos) return false;
    last_ = left_.front();
    left_.remove_prefix(1);
    return true;
  }
  /// Reads a word of ASCII letters and returns it in lower case. Returns an empty text if no letter follows.
  std::string word() {
    std::string text;
    while (!left_.empty() && std::isalpha(static_cast<unsigned char>(left_.front())) != 0) {
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(left_.front())));
      left_.remove_prefix(1);
    }
    return text;
  }
  void marks(std::string_view any) {
    while (mark(any)) continue;
  }
  [[nodiscard]] char last() const { return last_; }
  [[nodiscard]] bool done() const { return left_.empty(); }

  /// Reads the digits after the decimal mark of a time in seconds.
  /// @param value  receives the fraction [ns]; digits beyond 1 ns are ignored.
  bool fraction(Nanoseconds& value) {
    value = 0;
    Nanoseconds unit = ns_per_s;
    std::size_t count = 0;
    while (count < left_.size() && std::isdigit(static_cast<unsigned char>(left_[count])) != 0)
      value += (unit /= 10) * (left_[count++] - '0');
    left_.remove_prefix(count);
    return count > 0;
  }

 private:
  std::string_view left_;
  char last_ = 0;
};

/// Converts the hours of a 12-hour clock to 24 hours if "PM", "a.m." or a similar word follows; returns
/// nullopt if these hours are not from 1 to 12. Without such a word, returns the hours unchanged.
std::optional<std::int64_t> with_half_of_day(Scanner& scan, std::int64_t hours) {
  Scanner ahead = scan;
  ahead.marks(" ");
  std::string half = ahead.word();
  if (half.size() == 1 && ahead.mark(".")) half += ahead.word();
  if (half != "am" && half != "pm") return hours;
  (void)ahead.mark(".");
  scan = ahead;
  if (hours < 1 || hours > 12) return std::nullopt;
  return hours % 12 + (half == "pm" ? 12 : 0);
}

/// Reads an optional fraction of a second: digits after a point or comma, or 3 digits after a colon.
bool fraction_of(Scanner& scan, Nanoseconds& fraction) {
  std::int64_t milliseconds = 0;
  if (scan.mark(".,")) return scan.fraction(fraction);
  if (!scan.mark(":")) return true;
  if (!scan.digits(3, 3, milliseconds)) return false;
  fraction = milliseconds * (ns_per_s / 1000);
  return true;
}

std::optional<Nanoseconds> time_of_day(Scanner& scan) {
  std::int64_t hours = 0;
  std::int64_t minutes = 0;
  std::int64_t seconds = 0;
  Nanoseconds fraction = 0;
  if (!scan.digits(1, 2, hours) || !scan.mark(":") || !scan.digits(2, 2, minutes)) return std::nullopt;
  if (scan.mark(":") && !scan.digits(2, 2, seconds)) return std::nullopt;
  if (!fraction_of(scan, fraction)) return std::nullopt;
  const auto of_day = with_half_of_day(scan, hours);
  if (!of_day || *of_day > 23 || minutes > 59 || seconds > 60) return std::nullopt;
  return (3600 * *of_day + 60 * minutes + seconds) * ns_per_s + fraction;
}

/// Reads two fields ("00:59.5") as minutes and seconds. If the first field is at most 23 and the text has no
/// fraction, the fields may be hours and minutes instead.
std::optional<Moment> two_fields(std::string_view text) {
  Scanner scan(text);
  std::int64_t minutes = 0;
  std::int64_t seconds = 0;
  Nanoseconds fraction = 0;
  if (!scan.digits(1, 3, minutes) || !scan.mark(":") || !scan.digits(2, 2, seconds)) return std::nullopt;
  const bool has_fraction = scan.mark(".,");
  if (has_fraction && !scan.fraction(fraction)) return std::nullopt;
  if (!scan.done() || seconds > 59) return std::nullopt;
  return Moment{(60 * minutes + seconds) * ns_per_s + fraction, false, true, has_fraction || minutes > 23};
}

/// Reads the offset from UTC, such as "Z", "+02:00" or "-0500". If there is no offset, the time is in UTC.
std::optional<Nanoseconds> zone(Scanner& scan) {
  if (scan.done() || scan.mark("Z")) return 0;
  if (!scan.mark("+-")) return std::nullopt;
  const Nanoseconds sign = scan.last() == '-' ? -1 : 1;
  std::int64_t hours = 0;
  std::int64_t minutes = 0;
  if (!scan.digits(2, 2, hours)) return std::nullopt;
  (void)scan.mark(":");
  if (!scan.done() && !scan.digits(2, 2, minutes)) return std::nullopt;
  if (hours > 14 || minutes > 59) return std::nullopt;
  return sign * (3600 * hours + 60 * minutes) * ns_per_s;
}

std::optional<Nanoseconds> days_of(std::int64_t year, std::int64_t month, std::int64_t day_of_month) {
  const std::chrono::year_month_day day{std::chrono::year{static_cast<int>(year)},
                                        std::chrono::month{static_cast<unsigned>(month)},
                                        std::chrono::day{static_cast<unsigned>(day_of_month)}};
  if (!day.ok() || day.year() < std::chrono::year{1900} || day.year() > std::chrono::year{2200})
    return std::nullopt;
  return std::chrono::sys_days(day).time_since_epoch().count() * Nanoseconds{86400} * ns_per_s;
}

/// Returns the number of a month, 1 to 12, from its English or German name or the first three letters of this
/// name. Returns 0 for another word.
std::int64_t month_named(const std::string& word) {
  constexpr std::array<std::string_view, 12> english{"january",   "february", "march",    "april",
                                                     "may",       "june",     "july",     "august",
                                                     "september", "october",  "november", "december"};
  constexpr std::array<std::string_view, 12> german{"januar",    "februar", "maerz",    "april",
                                                    "mai",       "juni",    "juli",     "august",
                                                    "september", "oktober", "november", "dezember"};
  if (word.size() < 3) return 0;
  for (std::size_t i = 0; i < english.size(); ++i) {
    const bool short_form = word.size() == 3 || word == "sept";
    const auto is = [&](std::string_view name) {
      return word == name || (short_form && name.starts_with(word));
    };
    if (is(english[i]) || is(german[i])) return static_cast<std::int64_t>(i) + 1;
  }
  return 0;
}

/// Reads a date with the name of a month: 31-May-2024, 31 May 2024, May 31, 2024 or 2024-May-31.
std::optional<Nanoseconds> date_with_month_name(Scanner& scan) {
  constexpr std::string_view between = "-/., ";
  std::int64_t first = 0;
  std::int64_t second = 0;
  const bool number_first = scan.digits(1, 4, first);
  if (number_first && !scan.mark(between)) return std::nullopt;
  scan.marks(between);
  const std::int64_t month = month_named(scan.word());
  if (month == 0) return std::nullopt;
  scan.marks(between);
  if (!number_first) {
    if (!scan.digits(1, 2, first) || !scan.mark(between)) return std::nullopt;
    scan.marks(between);
  }
  if (!scan.digits(1, 4, second)) return std::nullopt;
  return first > 31 ? days_of(first, month, second) : days_of(second, month, first);
}

/// Reads 2024-05-31, 2024/05/31 or 31.05.2024. Returns the start of this day, as time since 1970.
std::optional<Nanoseconds> date(Scanner& scan) {
  std::array<std::int64_t, 3> parts{};
  if (!scan.digits(1, 4, parts[0]) || !scan.mark("-/.")) return std::nullopt;
  const char mark = scan.last();
  if (!scan.digits(1, 2, parts[1]) || !scan.mark({&mark, 1}) || !scan.digits(1, 4, parts[2]))
    return std::nullopt;
  const bool year_first = parts[0] > 31;
  if (!year_first && mark != '.') return std::nullopt;
  return year_first ? days_of(parts[0], parts[1], parts[2]) : days_of(parts[2], parts[1], parts[0]);
}

constexpr double ns_per_second = 1e9;
constexpr std::array<std::string_view, 5> second_words{"sec", "secs", "s", "second", "seconds"};
constexpr std::array<std::string_view, 7> nanosecond_words{"nanosec", "nanosecs",   "nsec",       "nsecs",
                                                           "ns",      "nanosecond", "nanoseconds"};

struct LastWord {
  std::string before;  ///< text before the last word, without the separator between them
  std::string word;    ///< last word, in lower case
};

/// Splits off the last word of a name: "header.stamp.sec" gives "header.stamp" and "sec".
LastWord last_word(std::string_view name) {
  const std::size_t at = name.find_last_of("._/ [(");
  std::string_view word = at == std::string_view::npos ? name : name.substr(at + 1);
  while (!word.empty() && (word.back() == ']' || word.back() == ')')) word.remove_suffix(1);
  std::string_view before = at == std::string_view::npos ? std::string_view() : name.substr(0, at);
  while (!before.empty() && std::string_view("._/ [(").find(before.back()) != std::string_view::npos)
    before.remove_suffix(1);
  return {std::string(before), lower_case(word)};
}

template <class Words>
bool is_one_of(const Words& words, const std::string& word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Returns true if the column contains a number, and all its numbers are whole numbers from 0 to below `end`.
bool whole_below(const TableColumn& column, double end) {
  bool any = false;
  for (const double value : column.values) {
    if (!std::isfinite(value)) continue;
    if (value != std::floor(value) || value < 0 || value >= end) return false;
    any = true;
  }
  return any && column.bad_count == 0 && column.moments == 0;
}

/// Returns the index of the column that contains the nanoseconds for the column `seconds`.
std::optional<std::size_t> rest_of_seconds(const std::vector<TableColumn>& columns, std::size_t seconds) {
  constexpr double latest_s = 1e11;
  const LastWord name = last_word(columns[seconds].name);
  if (!is_one_of(second_words, name.word) || !whole_below(columns[seconds], latest_s)) return std::nullopt;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const LastWord other = last_word(columns[i].name);
    const bool paired = other.before == name.before && is_one_of(nanosecond_words, other.word);
    if (paired && whole_below(columns[i], ns_per_second)) return i;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Moment> moment_of(std::string_view text) {
  if (const auto minutes = two_fields(text)) return minutes;
  Scanner alone(text);
  if (const auto time = time_of_day(alone); time && alone.done()) return Moment{*time};
  Scanner scan(text);
  auto day = date(scan);
  if (!day) {
    scan = Scanner(text);
    day = date_with_month_name(scan);
    (void)scan.mark(",");
  }
  if (!day || !scan.mark("T ")) return std::nullopt;
  const auto time = time_of_day(scan);
  if (!time) return std::nullopt;
  const auto offset = zone(scan);
  if (!offset || !scan.done()) return std::nullopt;
  return Moment{*day + *time - *offset, true, false, false};
}

std::optional<Nanoseconds> day_of(std::string_view text) {
  constexpr Nanoseconds day = 86400 * ns_per_s;
  auto moment = moment_of(text);
  if (!moment) moment = moment_of(std::string(text) + " 00:00:00");
  return moment && moment->dated && moment->time % day == 0 ? std::optional(moment->time) : std::nullopt;
}

bool DateColumn::has_name(std::string_view column) {
  const std::string name = lower_case(split_unit(column).name);
  return name == "date" || name == "datum";
}

void DateColumn::read(std::string_view text) {
  if (text.empty() || text == text_) return;
  const auto day = day_of(text);
  if (day && day_) {
    since_first_ += *day - *day_;
  } else if (!text_.empty()) {
    has_unread_change_ = true;
  }
  text_ = text;
  day_ = day;
}

bool DateColumn::take_unread_change() {
  return std::exchange(has_unread_change_, false);
}

std::string about_combined_times(const TableColumn& first, const TableColumn& second) {
  return "'" + document::shown(first.name, 40) + "' and '" + document::shown(second.name, 40) +
         "' are combined into one time";
}

std::string about_unused_dates(const TableColumn& dates, const TableColumn& times) {
  return "'" + document::shown(dates.name, 40) + "' does not change in the row in which '" +
         document::shown(times.name, 40) + "' passes midnight, so the dates are not used";
}

void combine_split_times(std::vector<TableColumn>& columns, std::vector<std::string>& notes) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto rest = rest_of_seconds(columns, i);
    if (!rest) continue;
    TableColumn& seconds = columns[i];
    TableColumn& nanoseconds = columns[*rest];
    for (std::size_t row = 0; row < seconds.values.size(); ++row)
      seconds.values[row] += nanoseconds.values[row] / ns_per_second;
    seconds.unit = "s";
    nanoseconds.is_part_of_time = true;
    std::string note = about_combined_times(seconds, nanoseconds);
    if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(std::move(note));
  }
}

}  // namespace softgrip::sysid
