#include "tools/commands/baseline_folder.h"

#include <filesystem>

#include "base/files.h"
#include "base/sha256.h"
#include "model/file/model_file.h"

namespace softgrip::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Failure = tl::unexpected<std::string>;

constexpr std::size_t largest_log = std::size_t{512} * 1024 * 1024;
constexpr std::size_t largest_json = std::size_t{16} * 1024 * 1024;

std::string file_of(const sysid::Log& log) {
  return fs::is_directory(log.path) ? (fs::path(log.path) / "run.csv").string() : log.path;
}

}  // namespace

tl::expected<std::string, std::string> write_baseline(const std::string& folder,
                                                      const std::vector<sysid::Log>& logs,
                                                      const model::Model& model, Json about) {
  about["logs"] = Json::array();
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const std::string name = "healthy_" + std::to_string(i + 1) + ".csv";
    const auto bytes = read_file(file_of(logs[i]), largest_log);
    if (!bytes) return Failure(bytes.error());
    if (const auto written = write_file((fs::path(folder) / name).string(), *bytes); !written)
      return Failure(written.error());
    about["logs"].push_back({{"file", name}, {"source", logs[i].path}, {"sha256", sha256(*bytes)}});
  }
  const std::string yaml = model::to_yaml(model);
  if (const auto written = write_file((fs::path(folder) / "model.yaml").string(), yaml); !written)
    return Failure(written.error());
  about["model"] = {{"file", "model.yaml"}, {"sha256", sha256(yaml)}};
  std::string text = about.dump(2) + "\n";
  if (const auto written = write_file((fs::path(folder) / "baseline.json").string(), text); !written)
    return Failure(written.error());
  return text;
}

tl::expected<Baseline, std::string> read_baseline(const std::string& folder) {
  const std::string path = (fs::path(folder) / "baseline.json").string();
  const auto text = read_file(path, largest_json);
  if (!text) return Failure(folder + " is no baseline: " + text.error());
  const Json json = Json::parse(*text, nullptr, false);
  if (!json.is_object() || !json.contains("logs") || !json["logs"].is_array() || !json.contains("model"))
    return Failure(path + " is not what softgrip baseline writes");
  Baseline baseline;
  const auto known = [&](const Json& entry) -> tl::expected<std::string, std::string> {
    if (!entry.is_object() || !entry.value("file", Json()).is_string() ||
        !entry.value("sha256", Json()).is_string())
      return Failure(path + " is not what softgrip baseline writes");
    const std::string file =
        (fs::path(folder) / fs::path(entry["file"].get<std::string>()).filename()).string();
    const auto bytes = read_file(file, largest_log);
    if (!bytes) return Failure(bytes.error());
    if (sha256(*bytes) != entry["sha256"].get<std::string>())
      return Failure(file + " is not the file that the baseline was made with: make the baseline again");
    return file;
  };
  for (const Json& entry : json["logs"]) {
    const auto file = known(entry);
    if (!file) return Failure(file.error());
    baseline.logs.push_back(*file);
  }
  const auto model = known(json["model"]);
  if (!model) return Failure(model.error());
  baseline.model = *model;
  if (baseline.logs.empty()) return Failure(path + " names no logs");
  return baseline;
}

}  // namespace softgrip::tools
