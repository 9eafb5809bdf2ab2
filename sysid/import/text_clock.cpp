#include "sysid/import/text_clock.h"

namespace softgrip::sysid {

double TextClock::add(const CellValue& cell, Nanoseconds days) {
  constexpr Nanoseconds half_day = 43200 * ns_per_s;
  const bool of_day = !cell.dated && !cell.short_clock;
  if (!begun_) {
    first_ = last_ = cell.moment;
    first_days_ = days;
  }
  begun_ = true;
  has_dates_ = has_dates_ || cell.dated;
  has_hours_ = has_hours_ || of_day;
  is_short_ = is_short_ || cell.short_clock;
  is_midnight_ = !cell.dated && last_ - cell.moment > half_day;
  last_ = cell.moment;
  return seconds(cell.moment - first_ + (of_day ? days - first_days_ : 0));
}

std::optional<Overflow> TextClock::continue_times(std::vector<double>& times_s,
                                                  const std::vector<double>& days_s) const {
  if (!begun_ || has_dates_ || !goes_back(times_s)) return std::nullopt;
  const double begin_s = seconds(first_);
  std::vector<double> of_period = times_s;
  for (std::size_t i = 0; i < of_period.size(); ++i) {
    const double added_s = days_s.empty() || is_short_ ? 0 : days_s[i] - seconds(first_days_);
    of_period[i] += begin_s - added_s;
  }
  std::vector<double> periods;
  if (is_short_) periods.push_back(hour_s);
  if (has_hours_) periods.push_back(day_s);
  const auto overflow = continue_overflows(of_period, periods);
  if (!overflow) return std::nullopt;
  for (std::size_t i = 0; i < of_period.size(); ++i) times_s[i] = of_period[i] - begin_s;
  return overflow;
}

}  // namespace softgrip::sysid
