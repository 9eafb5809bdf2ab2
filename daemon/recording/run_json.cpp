#include "daemon/recording/run_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "base/json.h"

namespace softgrip::daemon {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const LoadedSequence& sequence, std::uint32_t request) {
  return {{"name", sequence.prepared.name},
          {"file", sequence.written.file},
          {"sha256", sequence.sha256},
          {"request", request},
          {"parameters", parameters_json(sequence.prepared.parameters)},
          {"text", sequence.written.text}};
}

}  // namespace

Json parameters_json(const std::vector<control::Argument>& parameters) {
  Json json = Json::object();
  for (const control::Argument& parameter : parameters) json[parameter.name] = parameter.value;
  return json;
}

Json event_json(const EventEntry& event) {
  Json json;
  if (event.id != 0) json["id"] = event.id;
  json["time_s"] = event.time_s;
  json["kind"] = event.kind;
  json["severity"] = name_of(event.severity);
  if (!event.channel.empty()) json["channel"] = event.channel;
  if (!event.code.empty()) json["code"] = event.code;
  if (event.request != 0) json["request"] = event.request;
  if (!event.client.empty()) json["client"] = event.client;
  if (event.value != 0) json["value"] = std::isfinite(event.value) ? Json(event.value) : Json(nullptr);
  if (!event.parameters.empty()) json["parameters"] = parameters_json(event.parameters);
  json["text"] = event.text;
  return json;
}

std::string run_json(const Provenance& provenance, const RunStory& story) {
  Json json;
  json["schema"] = 1;
  json["state"] = story.state;
  json["reason"] = story.reason;
  json["software_version"] = provenance.software_version;
  if (!story.started_at.empty()) json["started_at"] = story.started_at;
  json["virtual_time"] = provenance.virtual_time;
  json["seed"] = provenance.seed ? Json(*provenance.seed) : Json(nullptr);
  json["rig"] = provenance.rig;
  json["files"] = Json::array();
  for (const SourceFile& file : provenance.files) {
    json["files"].push_back({{"role", file.role}, {"path", file.path}, {"sha256", file.sha256}});
  }
  json["channels"] = provenance.channel_names;
  json["rate_hz"] = provenance.rate_hz;
  json["decimation"] = provenance.decimation;
  json["sequence"] = story.sequence ? json_of(*story.sequence, story.request) : Json(nullptr);
  json["duration_s"] = story.duration_s;
  json["rows"] = story.rows;
  json["dropped_rows"] = story.dropped_rows;
  json["error"] = story.error.empty() ? Json(nullptr) : Json(story.error);
  json["faults"] = Json::array();
  json["events"] = Json::array();
  for (const EventEntry& event : story.events) {
    json["events"].push_back(event_json(event));
    if (event.kind == "fault_latched") json["faults"].push_back(event_json(event));
  }
  json["events_left_out"] = story.events_left_out;
  return json_dump(json, 1) + "\n";
}

}  // namespace softgrip::daemon
