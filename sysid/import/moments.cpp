#include "sysid/import/moments.h"

#include <array>
#include <cctype>
#include <chrono>
#include <cstdint>

namespace softgrip::sysid {
namespace {

/// Reads a text from the left.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : left_(text) {}

  /// `fewest` to `most` digits as a number.
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
  [[nodiscard]] char last() const { return last_; }
  [[nodiscard]] bool done() const { return left_.empty(); }

  /// A fraction of a second behind its mark; what is finer than a nanosecond is passed over.
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

std::optional<Nanoseconds> time_of_day(Scanner& scan) {
  std::int64_t hours = 0;
  std::int64_t minutes = 0;
  std::int64_t seconds = 0;
  Nanoseconds fraction = 0;
  if (!scan.digits(1, 2, hours) || !scan.mark(":") || !scan.digits(2, 2, minutes)) return std::nullopt;
  if (scan.mark(":") && !scan.digits(2, 2, seconds)) return std::nullopt;
  if (scan.mark(".,") && !scan.fraction(fraction)) return std::nullopt;
  if (hours > 23 || minutes > 59 || seconds > 60) return std::nullopt;
  return (3600 * hours + 60 * minutes + seconds) * ns_per_s + fraction;
}

/// "Z", "+02:00", "-0500", or nothing, which is taken for UTC.
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

/// Days since 1970 of 2024-05-31, 2024/05/31 or 31.05.2024.
std::optional<Nanoseconds> date(Scanner& scan) {
  std::array<std::int64_t, 3> parts{};
  if (!scan.digits(1, 4, parts[0]) || !scan.mark("-/.")) return std::nullopt;
  const char mark = scan.last();
  if (!scan.digits(1, 2, parts[1]) || !scan.mark({&mark, 1}) || !scan.digits(1, 4, parts[2]))
    return std::nullopt;
  const bool year_first = parts[0] > 31;
  if (!year_first && mark != '.') return std::nullopt;
  const std::chrono::year_month_day day{
      std::chrono::year{static_cast<int>(year_first ? parts[0] : parts[2])},
      std::chrono::month{static_cast<unsigned>(parts[1])},
      std::chrono::day{static_cast<unsigned>(year_first ? parts[2] : parts[0])}};
  if (!day.ok() || day.year() < std::chrono::year{1900} || day.year() > std::chrono::year{2200})
    return std::nullopt;
  return std::chrono::sys_days(day).time_since_epoch().count() * Nanoseconds{86400} * ns_per_s;
}

}  // namespace

std::optional<Moment> moment_of(std::string_view text) {
  Scanner alone(text);
  if (const auto time = time_of_day(alone); time && alone.done()) return Moment{*time, false};
  Scanner scan(text);
  const auto day = date(scan);
  if (!day || !scan.mark("T ")) return std::nullopt;
  const auto time = time_of_day(scan);
  if (!time) return std::nullopt;
  const auto offset = zone(scan);
  if (!offset || !scan.done()) return std::nullopt;
  return Moment{*day + *time - *offset, true};
}

}  // namespace softgrip::sysid
