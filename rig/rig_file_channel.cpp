// Reads the channels of a rig file.

#include <algorithm>
#include <cmath>

#include "base/numbers.h"
#include "control/feedforward/invertibility.h"
#include "control/feedforward/pressure_plan.h"
#include "rig/rig_file_reader.h"

namespace softgrip::rig {

namespace {

using document::Node;

/// Checks that each upper limit is above its lower limit. If one of the two has an error, the range is not
/// known. In this case, sets the upper limit to the lower limit, so that no later check uses the range.
void check_limits(MapReader& reader, control::LimitSettings& limits) {
  const auto ordered = [&](std::string_view lower, double least, std::string_view upper, double& most) {
    if (!reader.good(lower) || !reader.good(upper)) {
      most = least;
    } else if (most <= least) {
      reader.report(upper, "`" + std::string(upper) + "` must be above `" + std::string(lower) + "`");
    }
  };
  ordered("pressure_min_kpa", limits.pressure_min_kpa, "pressure_max_kpa", limits.pressure_max_kpa);
  ordered("displacement_min_mm", limits.displacement_min_mm, "displacement_max_mm",
          limits.displacement_max_mm);
}

/// Reads `rest_kpa`, the pressure of all safe states. If the key is missing, this pressure is 0 kPa, or the
/// end of the pressure range that is nearest to 0 kPa.
void read_rest_pressure(MapReader& reader, const std::string& who, control::LimitSettings& limits) {
  const bool limits_known = reader.good("limits") && limits.pressure_max_kpa > limits.pressure_min_kpa;
  read_keys(reader, rig_keys().rest_pressure, limits);
  if (!reader.good("rest_kpa") || !limits_known || control::resting_kpa(limits) == limits.rest_kpa) return;
  reader.report("rest_kpa",
                "`rest_kpa` must be in [" + written(limits.pressure_min_kpa) + ", " +
                    written(limits.pressure_max_kpa) + "], the pressure limits of " + who + ", found " +
                    written(limits.rest_kpa),
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
  // Adds the delay of the bus thread relative to the loop: a command of the loop waits for this time until
  // the bus thread sends it.
  channel.feedforward.extra_latency_s = context.rig.loop.bus_offset_fraction * context.period_s();
  read_keys(reader, rig_keys().feedforward, channel.feedforward);
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
  if (!channel.displacement_used && !channel.pressure_measured) {
    reader.report("displacement_used",
                  who + " must measure the displacement or the pressure, but measures neither",
                  "add `pressure_monitor`");
  }
  context.wiring.push_back(std::move(wiring));
  context.rig.valves.push_back(facts);
}

/// The maps `plausibility` and `model_health` at the top level of the file, which all channels share. A
/// channel may replace each of them by its own map.
struct Shared {
  const MapReader& top;
  control::ChannelSettings settings;
};

void read_plausibility(Context& context, MapReader& outer, control::PlausibilitySettings& settings) {
  read_map(outer, "plausibility", false, rig_keys().plausibility, settings, [&](MapReader& reader) {
    if (!context.rate_known || !reader.good("max_age_s") || settings.max_age_s > context.period_s()) return;
    reader.report("max_age_s",
                  "`max_age_s` must be longer than one cycle of the control loop, which is " +
                      written(context.period_s()) + " s",
                  "otherwise every reading would be older than `max_age_s`");
  });
}

void read_model_health(MapReader& outer, control::ModelHealthSettings& settings) {
  read_map(outer, "model_health", false, rig_keys().model_health, settings);
}

void read_own_or_shared(Context& context, MapReader& reader, const std::string& who, const Shared& shared,
                        control::ChannelSettings& channel) {
  if (!reader.has("plausibility")) channel.plausibility = shared.settings.plausibility;
  if (!reader.has("model_health")) channel.health = shared.settings.health;
  // An incomplete document may contain the shared maps in its unread part, so these maps are not reported as
  // missing.
  const bool judge = context.document.complete && !reader.keys().empty();
  read_plausibility(context, reader, channel.plausibility);
  read_model_health(reader, channel.health);
  for (const std::string key : {"plausibility", "model_health"}) {
    if (!judge || reader.has(key) || shared.top.has(key)) continue;
    reader.report(key, who + " has no `" + key + "`, and the top level of the rig file has none either",
                  "to share one `" + key + "` between all channels, put it at the top level of the file");
  }
}

void check_feedforward_exists(Context& context, MapReader& reader, const control::ChannelSettings& channel) {
  const auto exists =
      control::check_feedforward(channel.model, channel.feedforward, channel.limits, context.period_s());
  if (exists) return;
  // The feedforward `planned` needs no inverse of the model, so it suits most models that have no inverse.
  const control::FeedforwardSettings planned{control::FeedforwardKind::planned,
                                             channel.feedforward.extra_latency_s};
  const bool plannable =
      control::check_feedforward(channel.model, planned, channel.limits, context.period_s()).has_value();
  reader.report("feedforward", exists.error().with_advice(),
                plannable ? "use feedforward `planned`, which needs no inverse, because each sequence is "
                            "planned before its start"
                          : "");
}

/// Largest time [s], gain [mm/kPa] and rate [1/kPa] of the model of a soft finger.
constexpr double largest_model_value = 10;

constexpr std::string_view modes_id = "linear_modes";

/// Reports a value of a channel's model that is too large for a soft finger. `what` names the value.
void report_model_value(MapReader& reader, const std::string& what, double value, const std::string& unit) {
  reader.report("model",
                what + " of the model is " + written(value) + " " + unit +
                    ", but a controller allows at most " + written(largest_model_value) + " " + unit,
                "check the unit of the values in the model file");
}

/// Reports a settled gain of the block `linear_modes` above 10 mm/kPa. The gains of single modes may be
/// larger, because gains of opposite sign compensate each other.
void check_modes(MapReader& reader, const model::Model& model) {
  const model::Model modes =
      model::only(model, [](const model::BlockInfo& info) { return info.id == modes_id; });
  if (modes.blocks.empty()) return;
  control::LimitSettings unit_step;
  unit_step.pressure_min_kpa = 0;
  unit_step.pressure_max_kpa = 1;
  const double gain = control::settled_line(modes, unit_step).gain_mm_per_kpa;
  if (std::abs(gain) <= largest_model_value) return;
  report_model_value(reader, "the settled gain of `linear_modes`", gain,
                     model::in_unit("mm/kPa", model.output_unit));
}

/// Reports the times, gains and rates of a channel's model that are too large for a soft finger: more than 10
/// s, or more than 10 mm/kPa or 10/kPa. Model files may contain larger values, because they also describe
/// slow processes and pressures in MPa. In the model of a finger, such a value has a wrong unit.
void check_model_values(MapReader& reader, const model::Model& model) {
  check_modes(reader, model);
  const std::vector<double> values = model::flat_values(model);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const model::ParameterSpec& spec = model::parameter_spec(model, i);
    const std::string path = model::parameter_path(model, i);
    const bool limited = spec.latency || (spec.per_pressure && !path.starts_with(modes_id));
    if (!limited || std::abs(values[i]) <= largest_model_value) continue;
    report_model_value(reader, "`" + path + "`", values[i], model::in_unit(spec.unit, model.output_unit));
  }
}

void read_channel(Context& context, const Node& node, const Shared& shared, ChannelDefaults& defaults) {
  const std::size_t before = context.problems.size();
  const std::string number = "channel " + std::to_string(context.rig.settings.channels.size() + 1);
  const Node whole = defaults.completed(node);
  MapReader reader(context.document, whole, context.problems, number);
  control::ChannelSettings channel;
  read_keys(reader, rig_keys().channel, channel);
  channel.name = read_channel_name(context, reader);
  const std::string who = channel.name.empty() ? number : "channel `" + channel.name + "`";
  const auto model = named_model(context, reader, "model", InputFile::Role::model);
  if (model) {
    check_model_values(reader, *model);
    channel.model = *model;
  }
  read_feedforward(context, reader, channel);
  read_keys(reader, rig_keys().channel_parts, channel);
  read_map(
      reader, "pid", true, rig_keys().pid, channel.pid,
      [&](MapReader& pid) {
        (void)pid.child("tracking_time_s", channel.pid.anti_windup == control::AntiWindup::back_calculation);
      },
      "pid of " + who);
  read_map(
      reader, "limits", true, rig_keys().limits, channel.limits,
      [&](MapReader& limits) { check_limits(limits, channel.limits); }, "limits of " + who);
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
  Shared shared{top, {}};
  read_plausibility(context, top, shared.settings.plausibility);
  read_model_health(top, shared.settings.health);
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
