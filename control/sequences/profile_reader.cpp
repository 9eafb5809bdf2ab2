#include "control/sequences/profile_reader.h"

#include <string>
#include <vector>

namespace softgrip::control {

namespace {

using document::MapReader;

/// Reads the points of a pressure profile. The number of points has no limit of its own; the largest number
/// of values in a document limits it.
void read_points(MapReader& map, const document::Document& document, document::Problems& problems,
                 std::vector<Point>& points) {
  for (const document::Node* item : map.sequence("points", true)) {
    MapReader inner(document, *item, problems, "point");
    const Point point{inner.number("time_s", step_ranges::long_time_s),
                      inner.number("pressure_kpa", step_ranges::pressure_kpa)};
    if (points.empty() ? point.time_s != 0 : point.time_s < points.back().time_s) {
      inner.report("time_s", points.empty()
                                 ? "the first point must be at time_s: 0"
                                 : "time_s of a point must not be below time_s of the previous point");
    }
    points.push_back(point);
  }
  if (points.size() < 2 && map.has("points")) {
    map.report("points", "a profile needs at least two points");
  }
}

}  // namespace

void read_profile(MapReader& map, const document::Document& document, document::Problems& problems,
                  Profile& profile) {
  const bool has_signal = map.has("signal");
  const bool has_points = map.has("points");
  if (has_signal && has_points) {
    map.report("signal", "a pressure step has points or a signal, not both");
  }
  if (has_signal) {
    profile.signal = map.choice("signal", model::signal_names);
    profile.scale = map.optional_number("scale", {0.01, 20}).value_or(1);
  }
  if (has_points || !has_signal) read_points(map, document, problems, profile.points);
  profile.cycles = static_cast<std::uint32_t>(map.optional_integer("cycles", {1, 10'000}).value_or(1));
  if (profile.cycles > 1 && !profile.points.empty() &&
      profile.points.front().pressure_kpa != profile.points.back().pressure_kpa) {
    map.report("cycles", "the last point of a repeated profile must have the pressure of the first point");
  }
}

}  // namespace softgrip::control
