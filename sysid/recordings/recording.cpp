#include "sysid/recordings/recording.h"

#include <algorithm>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/json.h"
#include "base/numbers.h"

namespace softgrip::sysid {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::size_t longest_log = std::size_t{512} << 20U;
constexpr std::size_t longest_story = std::size_t{64} << 20U;

/// Returns the recipe of a sequence as text: "pick_stone 4419590a hold_s=5 squeeze_kpa=5".
std::string recipe_of(const json& sequence) {
  std::string recipe = json_text(sequence, "name") + " " + json_text(sequence, "sha256").substr(0, 8);
  const auto parameters = sequence.find("parameters");
  if (parameters == sequence.end() || !parameters->is_object()) return recipe;
  for (const auto& [name, value] : parameters->items()) {
    if (value.is_number()) recipe += " " + name + "=" + significant(value.get<double>(), 6);
  }
  return recipe;
}

/// Returns the content of the run.json of a folder; no object if run.json is missing or truncated.
json story_in(const std::string& folder) {
  const auto text = read_file((fs::path(folder) / "run.json").string(), longest_story);
  return text ? parse_json<json>(*text) : json();
}

/// Adds the data of run.json to a recording. If there are none, nothing is added.
void read_story(const json& story, Recording& recording) {
  if (!story.is_object()) return;
  recording.software_version = json_text(story, "software_version");
  recording.started_at = json_text(story, "started_at");
  recording.unfinished = json_text(story, "state") == "recording";
  if (const auto sequence = story.find("sequence"); sequence != story.end() && sequence->is_object()) {
    recording.sequence = json_text(*sequence, "name");
    recording.recipe = recipe_of(*sequence);
  }
  const auto events = story.find("events");
  if (events == story.end() || !events->is_array()) return;
  for (const json& event : *events) {
    if (!event.is_object() || !event.contains("time_s") || !event["time_s"].is_number()) continue;
    recording.events.push_back({event["time_s"].get<double>(), json_text(event, "kind"),
                                json_text(event, "channel"), json_text(event, "code"),
                                json_text(event, "text")});
  }
}

}  // namespace

tl::expected<Recording, std::string> read_recording(const std::string& path, document::Problems& problems) {
  const auto file = log_file_of(path);
  if (!file) return tl::unexpected(file.error());
  const std::string& csv = *file;
  const auto text = read_file(csv, longest_log);
  if (!text) return tl::unexpected(text.error());

  Recording recording = read_recording_data(path);
  LogOptions options;
  options.require_motion = false;
  options.need_readings = false;
  std::vector<std::string> channels = channels_of(*text);
  if (channels.empty()) channels.emplace_back();
  for (const std::string& channel : channels) {
    options.channel = channel;
    auto log = parse_log(csv, *text, problems, options);
    if (!log) return tl::unexpected(std::string());
    recording.channels.push_back(std::move(*log));
  }
  return recording;
}

Recording read_recording_data(const std::string& path) {
  Recording recording;
  recording.name = name_in_path(path);
  if (is_folder(path)) read_story(story_in(path), recording);
  return recording;
}

std::vector<double> numbers_of(const Log& log, const std::string& column) {
  std::vector<double> numbers;
  for (const std::string& cell : texts_of(log, column)) {
    numbers.push_back(to_number(cell).value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return numbers;
}

std::vector<std::string> texts_of(const Log& log, const std::string& column) {
  const auto found = std::find_if(log.others.begin(), log.others.end(),
                                  [&](const auto& other) { return other.name == column; });
  return found == log.others.end() ? std::vector<std::string>{} : found->cells;
}

}  // namespace softgrip::sysid
