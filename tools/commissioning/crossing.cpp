#include "tools/commissioning/motion.h"

#include <algorithm>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "rig/rig_file.h"

namespace softgrip::tools::doctor {
namespace {

using CrossingKind = Crossing::Kind;

/// Smallest change of a pressure monitor that counts as a response to a valve, as a share of the commanded
/// step.
constexpr double share_of_step = 0.5;

bool sensor_followed(const rig::RigFile& rig, const ChannelSample& rest, const Motion& motion,
                     std::size_t sensor) {
  const Sample& seen = motion.up[sensor].displacement_mm;
  if (!rig.settings.channels[sensor].displacement_used || seen.count == 0 || seen.invalid > 0) return false;
  return has_moved(rest.displacement_mm, seen, motion.model_mm);
}

bool monitor_followed(const rig::RigFile& rig, const ChannelSample& rest, const Motion& motion,
                      std::size_t moved, std::size_t monitor) {
  const Sample& seen = motion.up[monitor].pressure_kpa;
  if (seen.count == 0 || rest.pressure_kpa.count == 0) return false;
  const double step_kpa = motion.command_kpa - control::resting_kpa(rig.settings.channels[moved].limits);
  return (seen.mean - rest.pressure_kpa.mean) / step_kpa >= share_of_step;
}

/// Element i is the channel whose sensor responded when channel i was moved. Element i is nullopt if no
/// channel or more than one channel responded.
using Shown = std::vector<std::optional<std::size_t>>;

template <class Followed>
Shown who_showed(std::span<const Motion> motions, const Followed& followed) {
  const std::size_t count = motions.size();
  Shown shown(count);
  for (std::size_t moved = 0; moved < count; ++moved) {
    if (motions[moved].up.empty()) continue;
    std::size_t how_many = 0;
    for (std::size_t other = 0; other < count; ++other) {
      if (!followed(moved, other)) continue;
      shown[moved] = other;
      ++how_many;
    }
    if (how_many != 1) shown[moved].reset();
  }
  return shown;
}

/// Follows the channels from `first` on: the next channel is the channel that responded when the present
/// channel was moved. If this path returns to `first` through other channels, returns the channels of the
/// path. Otherwise, returns an empty vector.
std::vector<std::size_t> circle_from(const Shown& shown, std::size_t first) {
  std::vector<std::size_t> circle{first};
  for (auto next = shown[first]; next && *next != first; next = shown[*next]) {
    if (std::find(circle.begin(), circle.end(), *next) != circle.end()) return {};
    circle.push_back(*next);
  }
  const bool closed = shown[circle.back()] == first;
  return closed && circle.size() > 1 ? circle : std::vector<std::size_t>{};
}

std::vector<std::vector<std::size_t>> circles_of(const Shown& shown) {
  std::vector<std::vector<std::size_t>> circles;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const std::vector<std::size_t> circle = circle_from(shown, i);
    // Each cycle is reported once. The search finds a cycle from each of its channels, and the cycle is
    // reported for the channel with the lowest index.
    if (!circle.empty() && *std::min_element(circle.begin(), circle.end()) == i) circles.push_back(circle);
  }
  return circles;
}

std::string terminal(const rig::RigFile& rig, CrossingKind kind, std::size_t channel) {
  const drivers::ChannelWiring& wiring = rig.wiring[channel];
  const bool many = std::any_of(rig.wiring.begin(), rig.wiring.end(), [](const auto& other) {
    return other.valve.module > 0 || other.displacement.module > 0;
  });
  const bool valve = kind == CrossingKind::valves;
  const drivers::InputWiring& input =
      kind == CrossingKind::monitors && wiring.pressure ? *wiring.pressure : wiring.displacement;
  const std::size_t number = valve ? wiring.valve.output : input.input;
  const std::size_t module = valve ? wiring.valve.module : input.module;
  return fmt::format("{} {}{}", valve ? "output" : "input", number,
                     many ? fmt::format(" of module {}", module) : "");
}

}  // namespace

std::vector<Crossing> find_crossings(const rig::RigFile& rig, std::span<const ChannelSample> rest,
                                     std::span<const Motion> motions) {
  const auto sensors = circles_of(who_showed(motions, [&](std::size_t moved, std::size_t other) {
    return sensor_followed(rig, rest[other], motions[moved], other);
  }));
  const auto monitors = circles_of(who_showed(motions, [&](std::size_t moved, std::size_t other) {
    return monitor_followed(rig, rest[other], motions[moved], moved, other);
  }));
  const auto holds = [](const auto& circles, const std::vector<std::size_t>& circle) {
    return std::find(circles.begin(), circles.end(), circle) != circles.end();
  };
  std::vector<Crossing> crossings;
  crossings.reserve(sensors.size() + monitors.size());
  for (const auto& circle : sensors) {
    crossings.push_back({holds(monitors, circle) ? CrossingKind::valves : CrossingKind::sensors, circle});
  }
  for (const auto& circle : monitors) {
    if (!holds(sensors, circle)) crossings.push_back({CrossingKind::monitors, circle});
  }
  return crossings;
}

void tell_crossings(const rig::RigFile& rig, std::span<const Crossing> crossings, Findings& findings) {
  for (const Crossing& crossing : crossings) {
    const bool valves = crossing.kind == CrossingKind::valves;
    const char* const key = valves                                   ? "valve"
                            : crossing.kind == CrossingKind::sensors ? "sensor"
                                                                     : "pressure_monitor";
    std::string names;
    std::string shown;
    std::string terminals;
    for (std::size_t k = 0; k < crossing.channels.size(); ++k) {
      const std::size_t channel = crossing.channels[k];
      const std::size_t other = crossing.channels[(k + 1) % crossing.channels.size()];
      const std::string& name = rig.wiring[channel].name;
      const bool last = k + 1 == crossing.channels.size();
      names += (k > 0 ? ", " : "") + name;
      shown +=
          fmt::format("{}when `{}` was moved, {} of `{}` responded", k > 0 ? "; " : "", name,
                      valves ? "sensor and monitor" : fmt::format("the {}", key), rig.wiring[other].name);
      terminals += fmt::format("{}{} (`{}`)",
                               k == 0 ? ""
                               : last ? " and "
                                      : ", ",
                               terminal(rig, crossing.kind, channel), name);
    }
    const char* const what = valves                                   ? "valves "
                             : crossing.kind == CrossingKind::sensors ? "sensors "
                                                                      : "monitors ";
    findings.fail(what + names, "crossed: " + shown,
                  fmt::format("swap {}: exchange the wires of these terminals at the board, or exchange the "
                              "numbers under `{}` in the rig file{}",
                              terminals, key,
                              valves ? "; or swap the air lines between the valves and the fingers" : ""));
  }
}

bool is_crossed(std::span<const Crossing> crossings, CrossingKind kind, std::size_t channel) {
  return std::any_of(crossings.begin(), crossings.end(), [&](const Crossing& crossing) {
    return crossing.kind == kind &&
           std::find(crossing.channels.begin(), crossing.channels.end(), channel) != crossing.channels.end();
  });
}

}  // namespace softgrip::tools::doctor
