#include "sysid/changes/baseline_folder.h"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/json.h"
#include "base/sha256.h"

namespace softgrip::sysid {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Failure = tl::unexpected<std::string>;

constexpr std::size_t largest_log = std::size_t{512} * 1024 * 1024;
constexpr std::size_t largest_json = std::size_t{16} * 1024 * 1024;

}  // namespace

tl::expected<Baseline, std::string> read_baseline(const std::string& folder) {
  const std::string path = (fs::path(folder) / "baseline.json").string();
  const auto text = read_file(path, largest_json);
  if (!text) return Failure(folder + " is not a baseline folder: " + text.error());
  const Json json = parse_json<Json>(*text);
  if (!json.is_object() || !json.contains("logs") || !json["logs"].is_array() || !json.contains("model"))
    return Failure(path + " was not written by softgrip baseline");
  Baseline baseline;
  baseline.channel = json_text(json_member(json, "rig"), "channel");
  const auto known = [&](const Json& entry) -> tl::expected<std::string, std::string> {
    if (!entry.is_object() || !entry.value("file", Json()).is_string() ||
        !entry.value("sha256", Json()).is_string())
      return Failure(path + " was not written by softgrip baseline");
    const std::string file =
        (fs::path(folder) / fs::path(entry["file"].get<std::string>()).filename()).string();
    const auto bytes = read_file(file, largest_log);
    if (!bytes) return Failure(bytes.error());
    if (sha256(*bytes) != entry["sha256"].get<std::string>())
      return Failure(file +
                     " was changed after the baseline was recorded, so the baseline is invalid: record the "
                     "baseline again");
    return file;
  };
  const auto all = [&](const char* key, std::vector<std::string>& files) -> tl::expected<void, std::string> {
    for (const Json& entry : json.value(key, Json::array())) {
      const auto file = known(entry);
      if (!file) return Failure(file.error());
      files.push_back(*file);
    }
    return {};
  };
  if (const auto healthy = all("logs", baseline.logs); !healthy) return Failure(healthy.error());
  if (const auto second = all("second_run", baseline.second); !second) return Failure(second.error());
  if (json.contains("gauge") && !json["gauge"].is_null()) {
    const auto gauge = known(json["gauge"]);
    if (!gauge) return Failure(gauge.error());
    baseline.gauge = *gauge;
  }
  const auto model = known(json["model"]);
  if (!model) return Failure(model.error());
  baseline.model = *model;
  if (baseline.logs.empty()) return Failure(path + " lists no healthy logs");
  return baseline;
}

}  // namespace softgrip::sysid
