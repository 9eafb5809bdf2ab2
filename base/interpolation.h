#pragma once
// Interpolates a sampled series at other times.

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace softgrip {

/// Returns the values of a series at other times, with linear interpolation between its samples. Before the
/// first and after the last sample, the value of this sample is returned.
/// @param time_s  ascending times of the samples; at least one.
/// @param values  values at these times.
/// @param at_s  ascending times at which the series is interpolated.
[[nodiscard]] inline std::vector<double> interpolated(std::span<const double> time_s,
                                                      std::span<const double> values,
                                                      std::span<const double> at_s) {
  std::vector<double> out;
  out.reserve(at_s.size());
  std::size_t next = 0;
  for (const double s : at_s) {
    while (next + 1 < values.size() && time_s[next] < s) ++next;
    const bool is_outside = next == 0 || time_s[next] <= s;
    out.push_back(is_outside ? values[next]
                             : std::lerp(values[next - 1], values[next],
                                         (s - time_s[next - 1]) / (time_s[next] - time_s[next - 1])));
  }
  return out;
}

}  // namespace softgrip
