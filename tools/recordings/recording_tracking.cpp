#include "tools/recordings/recording_tracking.h"

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "sysid/recordings/recording.h"

namespace softgrip::tools {

std::vector<double> errors_of(const sysid::Log& log) {
  std::vector<double> errors = sysid::numbers_of(log, "reference_mm");
  for (std::size_t i = 0; i < errors.size(); ++i) errors[i] -= log.displacement_mm[i];
  return errors;
}

std::vector<char> gripping_of(const sysid::Log& log) {
  std::vector<char> gripping(log.size(), 0);
  const std::vector<std::string> steps = sysid::texts_of(log, "step");
  const std::vector<std::string> results = sysid::texts_of(log, "result");
  if (steps.empty() || results.empty()) return gripping;
  for (std::size_t begin = 0; begin < steps.size();) {
    std::size_t end = begin;
    bool held = false;
    for (; end < steps.size() && steps[end] == steps[begin]; ++end) held = held || results[end] == "holding";
    // The log states the result of a step at the first sample of the next step.
    held = held || (end < steps.size() && results[end] == "holding");
    if (held)
      std::fill(gripping.begin() + static_cast<std::ptrdiff_t>(begin),
                gripping.begin() + static_cast<std::ptrdiff_t>(end), char{1});
    begin = end;
  }
  return gripping;
}

Tracking tracking_of(const sysid::Log& log) {
  Tracking tracking;
  tracking.grips_known = !sysid::texts_of(log, "step").empty() && !sysid::texts_of(log, "result").empty();
  const std::vector<double> errors = errors_of(log);
  const std::vector<char> gripping = gripping_of(log);
  double squares = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (!std::isfinite(errors[i])) continue;
    if (gripping[i] != 0) {
      ++tracking.gripping_samples;
      tracking.gripping_largest_mm = std::max(tracking.gripping_largest_mm, errors[i]);
      continue;
    }
    ++tracking.free_samples;
    squares += errors[i] * errors[i];
    tracking.free_largest_mm = std::max(tracking.free_largest_mm, std::abs(errors[i]));
  }
  if (tracking.free_samples > 0) {
    tracking.free_rmse_mm = std::sqrt(squares / static_cast<double>(tracking.free_samples));
  }
  return tracking;
}

std::string to_text(const Tracking& tracking) {
  std::string text;
  if (tracking.free_samples > 0) {
    text = std::string(tracking.grips_known ? "free motion" : "tracking") + ": RMSE " +
           significant(tracking.free_rmse_mm, 3) + " mm, largest " +
           significant(tracking.free_largest_mm, 3) + " mm";
  }
  if (tracking.gripping_samples > 0) {
    text += (text.empty() ? "" : "; ") + std::string("gripping: up to ") +
            significant(tracking.gripping_largest_mm, 3) + " mm short of the reference";
  }
  return text;
}

}  // namespace softgrip::tools
