#include "sysid/evidence/signature.h"

#include <algorithm>
#include <cmath>

#include "sysid/limits/limits.h"

namespace softgrip::sysid {
namespace {

/// Lowest value of a quantity over all bins, and difference between its highest and lowest value.
class Extent {
 public:
  Extent(const std::vector<OperatingPoint>& conditions, double OperatingPoint::*of) : of_(of) {
    const auto less = [of](const OperatingPoint& a, const OperatingPoint& b) { return a.*of < b.*of; };
    if (conditions.empty()) return;
    const auto [low, high] = std::minmax_element(conditions.begin(), conditions.end(), less);
    low_ = (*low).*of;
    range_ = (*high).*of - low_;
  }
  /// Returns the position of a value between the lowest value (0) and the highest value (1).
  [[nodiscard]] double share(const OperatingPoint& condition) const {
    return range_ > 0 ? (condition.*of_ - low_) / range_ : 0;
  }

 private:
  double OperatingPoint::*of_;
  double low_ = 0, range_ = 0;
};

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
  std::vector<bool> required;
  required.reserve(conditions.size());
  for (const OperatingPoint& at : conditions) {
    const bool no_pressure = pressure.share(at) <= limits::rest_share;
    const bool still = at.rate_kpa_per_s <= limits::rest_share * highest_rate;
    switch (appears) {
      case Appears::anywhere:
        required.push_back(true);
        break;
      case Appears::at_rest:
        required.push_back(no_pressure && still);
        break;
      case Appears::displaced:
        required.push_back(motion.share(at) > 0.5);
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
