#include "daemon/socket/status_json.h"

#include <cmath>
#include <cstddef>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/json.h"
#include "base/periodic_schedule.h"
#include "control/elements/grip_result.h"
#include "daemon/recording/csv_row.h"

namespace softgrip::daemon {

namespace {

using Json = nlohmann::ordered_json;

constexpr double us_per_ns = 1e-3;

/// Returns a number as JSON; null for NaN, because JSON has no NaN.
Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json json_of_fault(control::FaultCode code) {
  if (code == control::FaultCode::none) return nullptr;
  const control::FaultInfo& info = control::info_of(code);
  return {{"code", info.id},
          {"name", info.name},
          {"meaning", info.meaning},
          {"cause", info.cause},
          {"remedy", info.remedy}};
}

/// Returns the latched fault and its remedy as JSON. If the cause of the fault is still present, the JSON
/// also contains the cause.
Json json_of_latched(const Snapshot& snapshot, const std::vector<std::string>& names) {
  Json json = json_of_fault(snapshot.first_fault.code);
  if (json.is_null()) return json;
  const control::Fault& cause = snapshot.cause;
  const bool is_fault_cleared = cause.code == control::FaultCode::none;
  json["channel"] = fault_title_json(snapshot.first_fault, names)["channel"];
  json["present"] = fault_title_json(cause, names);
  json["next"] =
      is_fault_cleared
          ? "The cause is gone: `softgrip acknowledge` clears the fault; nothing moves until the next start."
          : fmt::format(
                "The cause is still present: {}. `softgrip acknowledge` clears the fault once the cause is "
                "gone.",
                title_of(cause, names));
  return json;
}

/// Returns the path of the rig file that was given to the daemon.
Json rig_file_of(const Provenance& provenance) {
  for (const SourceFile& file : provenance.files) {
    if (file.role == "rig") return file.path;
  }
  return nullptr;
}

/// Returns the text as JSON; null if `is_there` is false.
Json text_or_null(std::string_view text, bool is_there) {
  return is_there ? Json(text) : Json(nullptr);
}

Json json_of_bus(const StatusSources& sources, const control::BusHealth& health) {
  const BusStatistics& bus = sources.bus;
  const Service::BusFailure& failure = sources.service.bus_failure();
  return {{"board", sources.board},
          {"connected", health.connected},
          {"fault", json_of_fault(health.fault)},
          {"consecutive_failures", health.consecutive_failures},
          {"answered", bus.exchange.summary().count > 0},
          {"attempts", bus.attempts.load(std::memory_order_relaxed)},
          {"retry_s", seconds(bus.retry_pause.load(std::memory_order_relaxed))},
          {"failure_kind", text_or_null(failure.kind, !failure.kind.empty())},
          {"failure", text_or_null(failure.text, !failure.text.empty())}};
}

Json json_of_channel(const control::ChannelSettings& settings, const control::ChannelOutput& channel) {
  const bool bound = channel.limit != control::BindingLimit::none;
  return {{"name", settings.name},
          {"command_kpa", number(channel.command_kpa)},
          {"pressure_kpa", number(channel.pressure_kpa)},
          {"temperature_c", number(channel.temperature_c)},
          {"displacement_mm", number(channel.displacement_mm)},
          {"reference_mm", number(channel.reference_mm)},
          {"feedforward_kpa", number(channel.feedforward_kpa)},
          {"feedback_kpa", number(channel.feedback_kpa)},
          {"residual_mm", number(channel.residual_mm)},
          {"shortfall_mm", number(channel.shortfall_mm)},
          {"deficit_mm", number(channel.shortfall_mm)},
          {"squeeze_kpa", number(channel.squeeze_kpa)},
          {"free_kpa", number(channel.free_kpa)},
          {"age_s", channel.validity == model::Validity::none_yet ? Json(nullptr) : number(channel.age_s)},
          {"validity", name_of(channel.validity)},
          {"displacement_used", settings.displacement_used},
          {"pressure_measured", settings.pressure_measured},
          {"result", control::title_of(channel.result)},
          {"evidence", control::name_of(channel.evidence)},
          {"saturated", channel.saturated},
          {"slewing", channel.slewing},
          {"limit", text_or_null(control::name_of(channel.limit), bound)},
          {"limit_text", text_or_null(control::words_of(channel.limit), bound)},
          {"health", control::name_of(channel.health)},
          {"health_rms_mm", number(channel.health_rms_mm)},
          {"limits",
           {{"pressure_min_kpa", settings.limits.pressure_min_kpa},
            {"pressure_max_kpa", settings.limits.pressure_max_kpa},
            {"rest_kpa", control::resting_kpa(settings.limits)},
            {"displacement_min_mm", settings.limits.displacement_min_mm},
            {"displacement_max_mm", settings.limits.displacement_max_mm}}}};
}

Json json_of_sequence(const Service& service, const Snapshot& snapshot) {
  const auto& sequence = service.sequence();
  if (!sequence) return nullptr;
  const std::size_t step = snapshot.channels.front().step;
  const auto& steps = sequence->prepared.steps;
  const std::string client = service.client_of(service.sequence_request());
  Json json{{"name", sequence->prepared.name},
            {"request", service.sequence_request()},
            {"client", client.empty() ? Json(nullptr) : Json(client)},
            {"parameters", parameters_json(sequence->prepared.parameters)},
            {"step", step},
            {"step_name", step < steps.size() ? steps[step].step.name : ""},
            {"steps", steps.size()}};
  const bool ended = service.last_finished().request == service.sequence_request();
  json["ended"] = ended ? Json(control::name_of(service.last_finished().end)) : Json(nullptr);
  return json;
}

std::string_view overall_title(const Service& service, const Snapshot& snapshot) {
  const std::uint32_t members = service.sequence() ? service.sequence()->prepared.channels : ~0U;
  std::vector<control::GripResult> results;
  for (std::size_t i = 0; i < snapshot.channel_count; ++i) results.push_back(snapshot.channels[i].result);
  return control::title_of(overall_result(results, members));
}

Json json_of(const RecorderStatus& recorder) {
  return {{"active", recorder.active},
          {"folder", recorder.folder.empty() ? Json(nullptr) : Json(recorder.folder)},
          {"rows", recorder.rows},
          {"dropped_rows", recorder.dropped_rows},
          {"error", recorder.error.empty() ? Json(nullptr) : Json(recorder.error)}};
}

Json json_of(const RealTimeReport* report) {
  if (report == nullptr) return nullptr;
  Json steps = Json::array();
  for (const RealTimeStep& step : report->steps()) {
    const bool requested = step.outcome != RealTimeStep::Outcome::not_requested;
    Json json{{"name", step.name},
              {"result", name_of(step.outcome)},
              // The key `outcome` is deprecated.
              {"outcome", requested ? name_of(step.outcome) : "not asked for"},  // words-ok: documented value
              {"detail", step.detail}};
    if (step.outcome == RealTimeStep::Outcome::failed) json["cost"] = step.cost;
    steps.push_back(std::move(json));
  }
  return {{"degraded", report->degraded()}, {"steps", std::move(steps)}};
}

/// Returns the states of the digital lines. The state of a line that the rig does not have is null.
Json json_of_gpio(const rig::GpioSettings* gpio, const SharedState* shared) {
  if (gpio == nullptr || shared == nullptr) return nullptr;
  const InputLevels& inputs = shared->inputs;
  Json json{{"emergency_stop", nullptr}, {"part_in_position", nullptr}, {"enable", nullptr}};
  using drivers::GpioRole;
  if (gpio->has(GpioRole::emergency_stop)) json["emergency_stop"] = inputs.emergency_stop.load();
  if (gpio->has(GpioRole::part_in_position)) json["part_in_position"] = !inputs.interlock_open.load();
  if (gpio->has(GpioRole::enable)) json["enable"] = shared->enable_on.load();
  json["lost"] = inputs.lost.load();
  return json;
}

Json json_of(const Histogram& histogram, bool with_bins) {
  const Histogram::Summary summary = histogram.summary();
  const auto us = [](std::int64_t ns) { return static_cast<double>(ns) * us_per_ns; };
  Json json{{"count", summary.count},
            {"min_us", us(summary.min_ns)},
            {"mean_us", summary.mean_ns * us_per_ns},
            {"p50_us", us(summary.p50_ns)},
            {"p99_us", us(summary.p99_ns)},
            {"p999_us", us(summary.p999_ns)},
            {"max_us", us(summary.max_ns)}};
  if (!with_bins) return json;
  Json bins = Json::array();
  for (const Histogram::Bin& bin : histogram.bins()) bins.push_back({us(bin.lower_ns), bin.count});
  json["bins_us"] = std::move(bins);
  return json;
}

Json json_of(const std::vector<EventCount>& events) {
  Json list = Json::array();
  for (const EventCount& event : events) {
    Json json{{"kind", event.kind}};
    if (!event.code.empty()) json["code"] = event.code;
    if (!event.channel.empty()) json["channel"] = event.channel;
    json["count"] = event.count;
    list.push_back(std::move(json));
  }
  return list;
}

}  // namespace

Json fault_title_json(const control::Fault& fault, const std::vector<std::string>& channel_names) {
  if (fault.code == control::FaultCode::none) return nullptr;
  const control::FaultInfo& info = control::info_of(fault.code);
  const bool of_channel = fault.channel < channel_names.size();
  return {{"code", info.id},
          {"name", info.name},
          {"channel", of_channel ? Json(channel_names[fault.channel]) : Json(nullptr)}};
}

Json status_json(const StatusSources& sources) {
  const Snapshot& snapshot = sources.service.snapshot();
  Json json{{"version", sources.provenance.software_version},
            {"rig", sources.provenance.rig},
            {"rig_file", rig_file_of(sources.provenance)},
            {"simulated", sources.provenance.simulated},
            {"rate_hz", sources.provenance.rate_hz},
            // Before the first tick, the snapshot has no valid time.
            {"time_s", snapshot.ticks == 0 ? 0.0 : seconds(snapshot.at - sources.origin)},
            {"state", control::name_of(snapshot.state)},
            {"under_pressure", under_pressure_json(sources.rig.channels, snapshot)},
            {"fault", json_of_latched(snapshot, sources.service.channel_names())},
            {"sequence", json_of_sequence(sources.service, snapshot)},
            {"result", overall_title(sources.service, snapshot)}};
  json["channels"] = Json::array();
  for (std::size_t i = 0; i < snapshot.channel_count; ++i) {
    json["channels"].push_back(json_of_channel(sources.rig.channels[i], snapshot.channels[i]));
  }
  json["bus"] = json_of_bus(sources, snapshot.bus);
  const Histogram::Summary wake_up = sources.loop.wake_up.summary();
  const auto overruns = sources.loop.overruns_woken_late.value() + sources.loop.overruns_took_long.value();
  json["loop"] = {{"ticks", snapshot.ticks},
                  {"overruns", overruns},
                  {"slips", overruns},
                  {"wake_up_p99_us", static_cast<double>(wake_up.p99_ns) * us_per_ns},
                  {"wake_up_max_us", static_cast<double>(wake_up.max_ns) * us_per_ns}};
  json["recording"] = json_of(sources.recorder.status());
  json["gpio"] = json_of_gpio(sources.gpio, sources.shared);
  json["real_time"] = json_of(sources.real_time);
  return json;
}

Json statistics_json(const StatusSources& sources, const std::vector<EventCount>& events,
                     bool with_histograms) {
  const LoopStatistics& loop = sources.loop;
  const BusStatistics& bus = sources.bus;
  return {{"loop",
           {{"ticks", loop.ticks.value()},
            {"overruns_woken_late", loop.overruns_woken_late.value()},
            {"overruns_took_long", loop.overruns_took_long.value()},
            {"slips_woken_late", loop.overruns_woken_late.value()},
            {"slips_took_long", loop.overruns_took_long.value()},
            {"wake_up", json_of(loop.wake_up, with_histograms)},
            {"compute", json_of(loop.compute, with_histograms)},
            {"reading_age", json_of(loop.reading_age, with_histograms)}}},
          {"bus",
           {{"exchanges", bus.exchanges.value()},
            {"failures", bus.failures.value()},
            {"sessions", bus.sessions.value()},
            {"overruns", bus.overruns.value()},
            {"slips", bus.overruns.value()},
            {"wake_up", json_of(bus.wake_up, with_histograms)},
            {"exchange", json_of(bus.exchange, with_histograms)}}},
          {"events", json_of(events)}};
}

std::string line_of(const Json& json) {
  return json_dump(json) + "\n";
}

Json under_pressure_json(const std::vector<control::ChannelSettings>& channels, const Snapshot& snapshot) {
  if (snapshot.under_pressure == 0) return nullptr;
  Json pressed = Json::array();
  std::string list;
  for (std::size_t i = 0; i < snapshot.channel_count; ++i) {
    const double command_kpa = snapshot.channels[i].command_kpa;
    if ((snapshot.under_pressure & (1U << i)) == 0) continue;
    pressed.push_back({{"name", channels[i].name}, {"command_kpa", command_kpa}});
    list += fmt::format("{}{} {:.1f} kPa", list.empty() ? "" : ", ", channels[i].name, command_kpa);
  }
  const bool idle = snapshot.state == control::State::idle;
  const char* const command = idle ? "softgrip release" : "softgrip vent";
  return {{"channels", std::move(pressed)},
          {"command", command},
          {"text",
           fmt::format("Fingers are pressurised: {}. `{}` vents them; a held part drops.", list, command)}};
}

}  // namespace softgrip::daemon
