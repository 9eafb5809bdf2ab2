#include "rig/check.h"

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "control/feedforward/free_curve.h"
#include "document/edit.h"

namespace softgrip::rig {

namespace {

using document::Location;
using document::Node;

/// Largest plausible ratio of the free finger's displacement at the pressure limit to the displacement limit.
/// The ratio may exceed 1, because gripping a part needs more pressure than free motion.
constexpr double most_times_too_far = 2;
/// Largest plausible ratio of `max_speed_mm_per_s` to the speed of the model. The ratio may exceed 1: a
/// finger that loses its part moves faster than the valve could move it.
constexpr double most_times_too_fast = 10;

const Node* channel_node(const document::Document& document, std::size_t channel) {
  const Node* const channels = document::below(&document.root, {"channels"});
  return channels != nullptr && channel < channels->items.size() ? &channels->items[channel] : nullptr;
}

/// Returns the location of the key that applies to a channel. The key may be in the channel, in
/// `channel_defaults`, or at the top level of the file.
Location place_of(const document::Document& document, std::size_t channel, std::string_view map,
                  std::string_view key) {
  const Node* const own = channel_node(document, channel);
  const Node* const shared = document::below(&document.root, {"channel_defaults"});
  for (const Node* const node : {document::below(own, {map, key}), document::below(shared, {map, key}),
                                 document::below(&document.root, {map, key})}) {
    if (node != nullptr) return node->at;
  }
  return own != nullptr ? own->at : document.root.at;
}

/// Returns a suggested value as text with 2 significant digits.
std::string about(double value) {
  if (value == 0) return "0";
  const double unit = std::pow(10, std::floor(std::log10(std::abs(value))) - 1);
  return significant(std::round(value / unit) * unit, 6);
}

/// One end of the pressure range, and the end of the displacement range that the finger reaches at this
/// pressure: keys and values of both.
struct Reach {
  const char* pressure;
  const char* displacement;
  double end_mm;
  double limit_mm;
};

void compare_reach(const document::Document& document, const control::ChannelSettings& channel,
                   std::size_t index, const control::FreeMotion& motion, document::Problems& problems) {
  const control::LimitSettings& limits = channel.limits;
  for (const Reach& reach :
       {Reach{"pressure_max_kpa", "displacement_max_mm", motion.highest_mm, limits.displacement_max_mm},
        Reach{"pressure_min_kpa", "displacement_min_mm", motion.lowest_mm, limits.displacement_min_mm}}) {
    const double allowed_mm = reach.limit_mm - motion.rest_mm;
    const double times = (reach.end_mm - motion.rest_mm) / allowed_mm;
    if (allowed_mm == 0 || !(times > most_times_too_far)) continue;
    const double enough_kpa = control::FreeCurve(channel.model, limits).command_kpa(reach.limit_mm);
    const std::string pressure = reach.pressure;
    problems.warn(document.problem(place_of(document, index, "limits", pressure),
                                   "at `" + pressure + "` the model of channel `" + channel.name +
                                       "` goes to " + about(reach.end_mm) + " mm, " + about(times) +
                                       " times the distance that the limit `" + reach.displacement + "` (" +
                                       significant(reach.limit_mm, 6) + " mm) allows",
                                   pressure + ": " + about(enough_kpa) +
                                       " is the pressure at which the model reaches this displacement"));
  }
}

void compare_speed(const document::Document& document, const control::ChannelSettings& channel,
                   std::size_t index, const control::FreeMotion& motion, document::Problems& problems) {
  const double allowed = channel.plausibility.max_speed_mm_per_s;
  if (!(motion.fastest_mm_per_s > 0) || allowed < most_times_too_fast * motion.fastest_mm_per_s) return;
  problems.warn(document.problem(
      place_of(document, index, "plausibility", "max_speed_mm_per_s"),
      "`max_speed_mm_per_s` is " + about(allowed / motion.fastest_mm_per_s) +
          " times the highest speed that the model of channel `" + channel.name +
          "` can reach within its slew limits (" + about(motion.fastest_mm_per_s) +
          " mm/s), so jumps of the sensor would count as motion",
      "max_speed_mm_per_s: " + about(3 * motion.fastest_mm_per_s) +
          " would reject jumps of the sensor and still permit the jump of a finger that loses its part"));
}

/// Returns the change of the rig file or of the wiring that makes a burst pressure line detectable.
std::string remedy(const RigFile& rig, std::size_t channel) {
  if (!rig.settings.channels[channel].pressure_measured) {
    return "connect the monitor output of the valve, or a pressure sensor, to an input of the board, and add "
           "`pressure_monitor` to the channel";
  }
  return "under `faults`: pressure_cycles: 20, pressure_tolerance_kpa: 5, pressure_delay_s: 0.5";
}

void compare_monitor(const document::Document& document, const RigFile& rig, std::size_t index,
                     document::Problems& problems) {
  if (sees_burst_line(rig, index)) return;
  const control::ChannelSettings& channel = rig.settings.channels[index];
  const Node* const faults = document::below(&document.root, {"faults"});
  const Node* const own = channel_node(document, index);
  const Node* const place = channel.pressure_measured ? faults : own;
  problems.warn(document.problem(
      place != nullptr ? place->at : document.root.at,
      channel.pressure_measured
          ? "the measured pressure of channel `" + channel.name +
                "` is not compared with its command, so a burst line would not be detected"
          : "channel `" + channel.name + "` has no `pressure_monitor`, so a burst line would not be detected",
      remedy(rig, index)));
}

}  // namespace

bool sees_burst_line(const RigFile& rig, std::size_t channel) {
  return rig.settings.channels[channel].pressure_measured && rig.settings.faults.pressure_cycles > 0;
}

void compare_limits(const document::Document& document, const RigFile& rig, document::Problems& problems) {
  for (std::size_t i = 0; i < rig.settings.channels.size(); ++i) {
    const control::ChannelSettings& channel = rig.settings.channels[i];
    const control::FreeMotion motion = control::free_motion(channel.model, channel.limits);
    compare_reach(document, channel, i, motion, problems);
    compare_speed(document, channel, i, motion, problems);
    compare_monitor(document, rig, i, problems);
  }
}

void compare_grips(const control::Sequence& sequence, const RigFile& rig, document::Problems& problems) {
  document::Document source;
  source.file = sequence.file;
  source.text = sequence.text;
  const auto uses = [](const std::vector<std::string>& names, const std::string& name) {
    return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
  };
  for (const control::Step& step : sequence.steps) {
    if (step.kind != control::StepKind::grip || step.verify.by == control::VerifyBy::pressure) continue;
    for (std::size_t i = 0; i < rig.settings.channels.size(); ++i) {
      const std::string& name = rig.settings.channels[i].name;
      if (sees_burst_line(rig, i) || !uses(step.channels.empty() ? sequence.channels : step.channels, name))
        continue;
      problems.warn(source.problem(step.at,
                                   "step '" + step.name +
                                       "' would also report HOLDING with a burst line: the rig `" + rig.name +
                                       "` does not detect a burst line on channel `" + name + "`",
                                   "in " + rig.path + ": " + remedy(rig, i)));
      return;
    }
  }
}

}  // namespace softgrip::rig
