#include "sysid/evidence/signature.h"

#include <algorithm>
#include <cmath>

#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Range of a quantity over all bins.
class Extent {
 public:
  Extent(const std::vector<OperatingPoint>& conditions, double OperatingPoint::*of) : of_(of) {
    const auto less = [of](const OperatingPoint& a, const OperatingPoint& b) { return a.*of < b.*of; };
    if (conditions.empty()) return;
    const auto [low, high] = std::minmax_element(conditions.begin(), conditions.end(), less);
    low_ = (*low).*of;
    high_ = (*high).*of;
  }
  /// Returns the position of a value between the lowest value (0) and the highest value (1).
  [[nodiscard]] double share(const OperatingPoint& condition) const {
    return high_ > low_ ? (condition.*of_ - low_) / (high_ - low_) : 0;
  }
  /// Returns the position of a value between the end of the range with the smaller magnitude (0) and the
  /// other end (1). The rest of a vacuum actuator is its highest pressure.
  [[nodiscard]] double share_from_rest(const OperatingPoint& condition) const {
    return std::abs(high_) < std::abs(low_) ? 1 - share(condition) : share(condition);
  }

 private:
  double OperatingPoint::*of_;
  double low_ = 0, high_ = 0;
};

bool is_without_pressure(const OperatingPoint& at, const Extent& pressure) {
  return pressure.share_from_rest(at) <= limits::rest_share;
}

/// Returns true if the mean displacement without pressure is in the upper half of the displacement range.
bool rests_in_upper_half(const std::vector<OperatingPoint>& conditions, const Extent& pressure,
                         const Extent& motion) {
  double sum = 0, count = 0;
  for (const OperatingPoint& at : conditions) {
    if (!is_without_pressure(at, pressure)) continue;
    sum += motion.share(at);
    ++count;
  }
  return sum > 0.5 * count;
}

}  // namespace

std::vector<double> rates_of(const Record& record) {
  constexpr double memory_s = 0.5;
  std::vector<double> rates(record.size(), 0);
  for (std::size_t i = 1; i < record.size(); ++i) {
    const double dt = record.duration_s[i];
    const double rate = dt > 0 ? std::abs(record.drive_kpa[i] - record.drive_kpa[i - 1]) / dt : 0;
    rates[i] = std::max(rate, rates[i - 1] * std::exp(-dt / memory_s));
  }
  return rates;
}

std::vector<bool> required_at(Appears appears, const std::vector<OperatingPoint>& conditions) {
  const Extent pressure(conditions, &OperatingPoint::pressure_kpa);
  double highest_rate = 0;
  for (const OperatingPoint& at : conditions) highest_rate = std::max(highest_rate, at.rate_kpa_per_s);
  const Extent motion(conditions, &OperatingPoint::motion);
  const bool rests_high = rests_in_upper_half(conditions, pressure, motion);
  std::vector<bool> required;
  required.reserve(conditions.size());
  for (const OperatingPoint& at : conditions) {
    const bool no_pressure = is_without_pressure(at, pressure);
    const bool still = at.rate_kpa_per_s <= limits::rest_share * highest_rate;
    switch (appears) {
      case Appears::anywhere:
        required.push_back(true);
        break;
      case Appears::at_rest:
        required.push_back(no_pressure && still);
        break;
      case Appears::displaced:
        required.push_back((rests_high ? 1 - motion.share(at) : motion.share(at)) > 0.5);
        break;
      case Appears::held:
        required.push_back(!no_pressure && still);
        break;
      case Appears::moving:
        required.push_back(at.rate_kpa_per_s > 0.5 * highest_rate);
        break;
    }
  }
  return required;
}

bool is_met(const std::vector<bool>& required) {
  return static_cast<std::size_t>(std::count(required.begin(), required.end(), true)) >=
         limits::fewest_occurrences;
}

std::string_view recording_for(Appears appears) {
  switch (appears) {
    case Appears::at_rest:
      return "record a rest without pressure at the beginning and at the end";
    case Appears::displaced:
      return "record a run up to the highest pressure";
    case Appears::held:
      return "record a run that holds a pressure for some seconds";
    case Appears::moving:
      return "record a run in which the pressure changes at several rates";
    case Appears::anywhere:
      break;
  }
  return "record the same run again, as a separate log";
}

}  // namespace softgrip::sysid
