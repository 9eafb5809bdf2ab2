#include "tools/commands/baseline_folder.h"

#include <unistd.h>

#include <filesystem>
#include <system_error>
#include <utility>

#include "base/files.h"
#include "base/json.h"
#include "base/sha256.h"
#include "daemon/service/signals.h"
#include "model/file/model_file.h"

namespace softgrip::tools {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Failure = tl::unexpected<std::string>;

constexpr std::size_t largest_log = std::size_t{512} * 1024 * 1024;

std::string file_of(const sysid::Log& log) {
  return is_folder(log.path) ? (fs::path(log.path) / "run.csv").string() : log.path;
}

/// Writes files one by one until the first failure, and collects their entries for baseline.json.
class FolderWriter {
 public:
  explicit FolderWriter(std::string folder) : folder_(std::move(folder)) {}

  Json write(const std::string& name, const std::string& bytes, const std::string& source = "") {
    if (why_.empty()) {
      if (auto written = write_file((fs::path(folder_) / name).string(), bytes); !written)
        why_ = written.error();
    }
    Json entry{{"file", name}};
    if (!source.empty()) entry["source"] = source;
    entry["sha256"] = sha256(bytes);
    return entry;
  }
  Json write_all(const std::string& name, const std::vector<BaselineFile>& files) {
    Json list = Json::array();
    for (std::size_t i = 0; i < files.size(); ++i)
      list.push_back(write(name + std::to_string(i + 1) + ".csv", files[i].bytes, files[i].source));
    return list;
  }
  [[nodiscard]] const std::string& why() const { return why_; }

 private:
  std::string folder_;
  std::string why_;
};

tl::expected<std::string, std::string> write_into(const std::string& folder, const BaselineContents& contents,
                                                  Json about) {
  FolderWriter writer(folder);
  about["logs"] = writer.write_all("healthy_", contents.healthy);
  about["second_run"] = writer.write_all("second_", contents.second);
  about["gauge"] = nullptr;
  if (contents.gauge)
    about["gauge"] = writer.write("gauge.csv", contents.gauge->bytes, contents.gauge->source);
  about["model"] = writer.write("model.yaml", model::to_yaml(contents.model));
  std::string text = json_dump(about, 2) + "\n";
  (void)writer.write("baseline.json", text);
  if (!writer.why().empty()) return Failure(writer.why());
  return text;
}

}  // namespace

std::vector<std::string> baseline_files() {
  return {"healthy_*.csv", "second_*.csv", "gauge.csv", "model.yaml", "baseline.json"};
}

tl::expected<BaselineFile, std::string> baseline_file(const std::string& path) {
  auto bytes = read_file(path, largest_log);
  if (!bytes) return Failure(bytes.error());
  return BaselineFile{path, std::move(*bytes)};
}

tl::expected<std::vector<BaselineFile>, std::string> files_of(const std::vector<sysid::Log>& logs) {
  std::vector<BaselineFile> files;
  for (const sysid::Log& log : logs) {
    auto file = baseline_file(file_of(log));
    if (!file) return Failure(file.error());
    files.push_back({log.path, std::move(file->bytes)});
  }
  return files;
}

tl::expected<std::string, std::string> write_baseline(const std::string& folder,
                                                      const BaselineContents& contents, Json about) {
  const daemon::Signals held_back;
  std::error_code ignored;
  const fs::path place = fs::path(folder).has_filename() ? fs::path(folder) : fs::path(folder).parent_path();
  if (fs::exists(place, ignored)) return write_into(place.string(), contents, std::move(about));
  const std::string partial = place.string() + ".partial-" + std::to_string(::getpid());
  auto text = write_into(partial, contents, std::move(about));
  std::error_code failed;
  if (text) fs::rename(partial, place, failed);
  if (text && failed) text = Failure("cannot make " + folder + ": " + failed.message());
  if (!text) fs::remove_all(partial, ignored);
  return text;
}

}  // namespace softgrip::tools
