#include <cmath>
#include <string>
#include <utility>

#include "base/numbers.h"
#include "base/version.h"
#include "library/include/softgrip/error.h"
#include "library/include/softgrip/version.h"
#include "library/model_parts.h"

namespace softgrip {

Error::~Error() = default;
InvalidArgument::InvalidArgument(std::string argument, const std::string& problem)
    : Error(argument + ": " + problem), argument_(std::move(argument)) {}
InvalidArgument::~InvalidArgument() = default;
FileError::~FileError() = default;
Refused::~Refused() = default;
Cancelled::~Cancelled() = default;

std::string version() {
  return std::string(software_version());
}

namespace library {

void refuse(const document::Problems& problems) {
  std::string text = problems.without_repeats().format();
  while (!text.empty() && text.back() == '\n') text.pop_back();
  throw FileError(text);
}

void require_size(const std::string& argument, std::size_t size, std::size_t count, const std::string& unit) {
  if (size == count) return;
  throw InvalidArgument(argument, std::to_string(size) + " values, but there are " + std::to_string(count) +
                                      " times. One value per time is required, in " + unit);
}

void require_finite(const std::string& argument, std::span<const double> values, const std::string& unit) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i]))
      throw InvalidArgument(argument, "value " + std::to_string(i) + " is " + shortest(values[i]) +
                                          ". All values must be finite numbers in " + unit);
  }
}

void require_times(const std::string& argument, std::span<const double> time_s, std::size_t fewest) {
  if (time_s.size() < fewest)
    throw InvalidArgument(argument, std::to_string(time_s.size()) + " values; at least " +
                                        std::to_string(fewest) + " times in s are required");
  require_finite(argument, time_s, "s");
  for (std::size_t i = 1; i < time_s.size(); ++i) {
    if (!(time_s[i] > time_s[i - 1]))
      throw InvalidArgument(argument, "value " + std::to_string(i) + " (" + shortest(time_s[i]) +
                                          " s) is not above the previous value (" + shortest(time_s[i - 1]) +
                                          " s). Times must increase");
  }
}

void require_between(const std::string& argument, double value, double lower, double upper,
                     const std::string& unit) {
  if (value >= lower && value <= upper) return;
  const std::string with_unit = unit.empty() ? "" : " " + unit;
  throw InvalidArgument(argument, shortest(value) + with_unit + " is not between " + written(lower) +
                                      " and " + written(upper) + with_unit);
}

void require_positive(const std::string& argument, double value, const std::string& unit) {
  if (std::isfinite(value) && value > 0) return;
  throw InvalidArgument(argument, shortest(value) + " " + unit + " is not a finite number above 0 " + unit);
}

}  // namespace library
}  // namespace softgrip
