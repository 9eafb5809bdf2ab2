// Reads the channels of a rig file.

#include <algorithm>

#include "base/numbers.h"
#include "control/feedforward/invertibility.h"
#include "rig/channel_defaults.h"

namespace softgrip::rig {

namespace {

using document::Node;

/// Gauge pressures and displacements that a rig file may contain, for any supported finger. The limits of a
/// rig are narrower than these ranges.
constexpr document::Range any_pressure_kpa{-100, 2000};
constexpr document::Range any_displacement_mm{-1000, 1000};

control::PidSettings read_pid(Context& context, const Node& node, const std::string& who) {
  MapReader reader(context.document, node, context.problems, "pid of " + who);
  control::PidSettings pid;
  pid.kp_kpa_per_mm = reader.number("kp_kpa_per_mm", {0, 1e6});
  pid.ki_kpa_per_mm_s = reader.number("ki_kpa_per_mm_s", {0, 1e6});
  pid.kd_kpa_s_per_mm = reader.number("kd_kpa_s_per_mm", {0, 1e6});
  pid.derivative_filter_s = reader.number("derivative_filter_s", {0, 100});
  pid.setpoint_weight = reader.number("setpoint_weight", {0, 1});
  pid.anti_windup = static_cast<control::AntiWindup>(
      reader.choice("anti_windup", {"none", "conditional", "back_calculation"}));
  constexpr document::Range tracking{1e-4, 1000};
  if (pid.anti_windup == control::AntiWindup::back_calculation) {
    pid.tracking_time_s = reader.number("tracking_time_s", tracking);
  } else {
    pid.tracking_time_s = reader.optional_number("tracking_time_s", tracking).value_or(pid.tracking_time_s);
  }
  return pid;
}

control::LimitSettings read_limits(Context& context, const Node& node, const std::string& who) {
  MapReader reader(context.document, node, context.problems, "limits of " + who);
  control::LimitSettings limits;
  limits.pressure_min_kpa = reader.number("pressure_min_kpa", any_pressure_kpa);
  limits.pressure_max_kpa = reader.number("pressure_max_kpa", any_pressure_kpa);
  limits.slew_up_kpa_per_s = reader.number("slew_up_kpa_per_s", {0.001, 1e6});
  limits.slew_down_kpa_per_s = reader.number("slew_down_kpa_per_s", {0.001, 1e6});
  limits.displacement_min_mm = reader.number("displacement_min_mm", any_displacement_mm);
  limits.displacement_max_mm = reader.number("displacement_max_mm", any_displacement_mm);
  limits.displacement_margin_mm = reader.number("displacement_margin_mm", {0, 1000});
  const auto ordered = [&](std::string_view lower, double least, std::string_view upper, double most) {
    if (reader.good(lower) && reader.good(upper) && most <= least) {
      reader.report(upper, "`" + std::string(upper) + "` must be above `" + std::string(lower) + "`");
    }
  };
  ordered("pressure_min_kpa", limits.pressure_min_kpa, "pressure_max_kpa", limits.pressure_max_kpa);
  ordered("displacement_min_mm", limits.displacement_min_mm, "displacement_max_mm",
          limits.displacement_max_mm);
  return limits;
}

/// Reads `rest_kpa`, the pressure of all safe states. If the key is missing, this pressure is 0 kPa, limited
/// to the pressure range.
void read_rest_pressure(MapReader& reader, const std::string& who, control::LimitSettings& limits) {
  const bool limits_known = reader.good("limits") && limits.pressure_max_kpa > limits.pressure_min_kpa;
  const auto rest_kpa = reader.optional_number("rest_kpa", any_pressure_kpa);
  if (!rest_kpa) return;
  limits.rest_kpa = *rest_kpa;
  if (!reader.good("rest_kpa") || !limits_known || control::resting_kpa(limits) == *rest_kpa) return;
  reader.report("rest_kpa",
                "`rest_kpa` must be in [" + written(limits.pressure_min_kpa) + ", " +
                    written(limits.pressure_max_kpa) + "], the pressure limits of " + who + ", found " +
                    written(*rest_kpa),
                "`rest_kpa` is the pressure of every safe state");
}

/// Reads the name of a channel. This function is called before all other keys are read, because messages
/// about the keys contain the name.
std::string read_channel_name(Context& context, MapReader& reader) {
  std::string name = read_name(reader, "name");
  if (name.empty()) return name;
  const auto [first, fresh] = context.names.try_emplace(name, reader.where("name"));
  if (!fresh) report_repeated(reader, "name", "the name `" + name + "`", first->second);
  return name;
}

void read_feedforward(Context& context, MapReader& reader, control::ChannelSettings& channel) {
  channel.feedforward.kind = static_cast<control::FeedforwardKind>(
      reader.choice("feedforward", {control::feedforward_names.begin(), control::feedforward_names.end()}));
  // A command of the loop waits until the bus thread sends it. This is the delay of the bus thread relative
  // to the loop.
  const double lag_s = context.rig.loop.bus_offset_fraction * context.period_s();
  channel.feedforward.extra_latency_s = reader.optional_number("extra_latency_s", {0, 1}).value_or(lag_s);
}

void read_wiring(Context& context, MapReader& reader, const std::string& who,
                 control::ChannelSettings& channel) {
  drivers::ChannelWiring wiring;
  ValveFacts facts;
  wiring.name = channel.name;
  if (const Node* valve = reader.child("valve", true)) {
    wiring.valve = read_valve(context, *valve, who, channel.limits, reader.has("rest_kpa"), facts);
  }
  if (const Node* sensor = reader.child("sensor", true)) {
    wiring.displacement = read_sensor(context, *sensor, who, channel.limits);
  }
  if (const Node* monitor = reader.child("pressure_monitor", false)) {
    wiring.pressure = read_pressure_monitor(context, *monitor, who);
  }
  if (const Node* thermometer = reader.child("temperature_sensor", false)) {
    wiring.temperature = read_temperature_sensor(context, *thermometer, who);
  }
  channel.pressure_measured = wiring.pressure.has_value();
  channel.displacement_used = reader.optional_boolean("displacement_used").value_or(true);
  if (!channel.displacement_used && !channel.pressure_measured) {
    reader.report("displacement_used",
                  who + " must measure the displacement or the pressure, but measures neither",
                  "add `pressure_monitor`");
  }
  context.wiring.push_back(std::move(wiring));
  context.rig.valves.push_back(facts);
}

/// Settings that all channels share. A channel may replace each of them by its own setting.
struct Shared {
  std::optional<control::PlausibilitySettings> plausibility;
  std::optional<control::ModelHealthSettings> health;
};

void read_own_or_shared(Context& context, MapReader& reader, const std::string& who, const Shared& shared,
                        control::ChannelSettings& channel) {
  // If the document is incomplete, the shared maps may be in the part that was not read, so they are not
  // reported as missing.
  const bool judge = context.document.complete && !reader.keys().empty();
  const Node* const plausibility = reader.child("plausibility", false);
  if (plausibility != nullptr) {
    channel.plausibility = read_plausibility(context, *plausibility);
  } else if (shared.plausibility) {
    channel.plausibility = *shared.plausibility;
  } else if (judge) {
    reader.report("plausibility",
                  who + " has no `plausibility`, and the top level of the rig file has none either",
                  "to share one `plausibility` between all channels, put it at the top level of the file");
  }
  const Node* const health = reader.child("model_health", false);
  if (health != nullptr) {
    channel.health = read_model_health(context, *health);
  } else if (shared.health) {
    channel.health = *shared.health;
  } else if (judge) {
    reader.report("model_health",
                  who + " has no `model_health`, and the top level of the rig file has none either",
                  "to share one `model_health` between all channels, put it at the top level of the file");
  }
}

void check_feedforward_exists(Context& context, MapReader& reader, const control::ChannelSettings& channel) {
  const auto exists =
      control::check_feedforward(channel.model, channel.feedforward, channel.limits, context.period_s());
  if (exists) return;
  // Most models without an inverse can use the feedforward `planned`, because it needs no inverse.
  const control::FeedforwardSettings planned{control::FeedforwardKind::planned,
                                             channel.feedforward.extra_latency_s};
  const bool plannable =
      control::check_feedforward(channel.model, planned, channel.limits, context.period_s()).has_value();
  reader.report("feedforward", exists.error().with_advice(),
                plannable ? "use feedforward `planned`, which needs no inverse, because each sequence is "
                            "planned before its start"
                          : "");
}

void read_channel(Context& context, const Node& node, const Shared& shared, ChannelDefaults& defaults) {
  const std::size_t before = context.problems.size();
  const std::string number = "channel " + std::to_string(context.rig.settings.channels.size() + 1);
  const Node whole = defaults.completed(node);
  MapReader reader(context.document, whole, context.problems, number);
  control::ChannelSettings channel;
  channel.name = read_channel_name(context, reader);
  const std::string who = channel.name.empty() ? number : "channel `" + channel.name + "`";
  const auto model = named_model(context, reader, "model", InputFile::Role::model);
  if (model) channel.model = *model;
  read_feedforward(context, reader, channel);
  if (const Node* pid = reader.child("pid", true)) channel.pid = read_pid(context, *pid, who);
  if (const Node* limits = reader.child("limits", true)) channel.limits = read_limits(context, *limits, who);
  read_rest_pressure(reader, who, channel.limits);
  const bool motion_known = model && context.problems.size() == before && context.rate_known &&
                            reader.good("feedforward") && reader.good("pid") && reader.good("limits");
  read_wiring(context, reader, who, channel);
  read_own_or_shared(context, reader, who, shared, channel);
  reader.finish();
  if (model && context.problems.size() == before && !defaults.spoiled() && context.document.complete) {
    check_feedforward_exists(context, reader, channel);
  }
  context.motion_known.push_back(motion_known && !defaults.spoiled());
  defaults.settle(before);
  context.rig.settings.channels.push_back(std::move(channel));
}

}  // namespace

void read_channels(Context& context, MapReader& top) {
  Shared shared;
  if (const Node* node = top.child("plausibility", false)) {
    shared.plausibility = read_plausibility(context, *node);
  }
  if (const Node* node = top.child("model_health", false)) {
    shared.health = read_model_health(context, *node);
  }
  ChannelDefaults defaults(context, top);
  const std::vector<const Node*> channels = top.sequence("channels", true);
  if (top.has("channels") && channels.empty() && context.document.complete) {
    top.report("channels", "a rig must have at least one channel");
  }
  if (channels.size() > control::max_channels) {
    top.report("channels", "a rig may have at most " + std::to_string(control::max_channels) +
                               " channels, found " + std::to_string(channels.size()));
  }
  for (std::size_t i = 0; i < std::min(channels.size(), control::max_channels); ++i) {
    read_channel(context, *channels[i], shared, defaults);
  }
}

}  // namespace softgrip::rig
