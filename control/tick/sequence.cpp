#include "control/tick/sequence.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace softgrip::control {

std::string_view name_of(StepKind kind) noexcept {
  constexpr std::array<std::string_view, 6> names{"move", "grip", "hold", "release", "track", "pressure"};
  return names[static_cast<std::size_t>(kind)];
}

std::string_view name_of(OnFail action) noexcept {
  constexpr std::array<std::string_view, 5> names{"vent", "hold", "abort", "release", "continue"};
  return names[static_cast<std::size_t>(action)];
}

std::string_view name_of(VerifyBy by) noexcept {
  constexpr std::array<std::string_view, 3> names{"detection", "position", "pressure"};
  return names[static_cast<std::size_t>(by)];
}

double cycle_s(const Profile& profile) noexcept {
  if (profile.signal) {
    return model::duration_s(*profile.signal);
  }
  return profile.points.empty() ? 0 : profile.points.back().time_s;
}

double duration_s(const Profile& profile) noexcept {
  return cycle_s(profile) * profile.cycles;
}

namespace {

double value_of_points(const std::vector<Point>& points, double time_s) noexcept {
  const auto after = std::upper_bound(points.begin(), points.end(), time_s,
                                      [](double t, const Point& point) { return t < point.time_s; });
  if (after == points.begin()) {
    return points.front().pressure_kpa;
  }
  if (after == points.end()) {
    return points.back().pressure_kpa;
  }
  const Point& before = *(after - 1);
  const double share = (time_s - before.time_s) / (after->time_s - before.time_s);
  return before.pressure_kpa + share * (after->pressure_kpa - before.pressure_kpa);
}

}  // namespace

double value_at(const Profile& profile, double time_s) noexcept {
  const double one = cycle_s(profile);
  double in_cycle = std::clamp(time_s, 0.0, one * profile.cycles);
  if (one > 0) {
    const double done = std::min(std::floor(in_cycle / one), static_cast<double>(profile.cycles) - 1);
    in_cycle -= done * one;
  }
  if (profile.signal) {
    return profile.scale * model::value_kpa(*profile.signal, in_cycle);
  }
  return profile.points.empty() ? 0 : value_of_points(profile.points, in_cycle);
}

}  // namespace softgrip::control
