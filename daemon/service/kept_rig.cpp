#include "daemon/service/kept_rig.h"

#include <filesystem>
#include <system_error>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/sha256.h"
#include "daemon/service/board_lock.h"
#include "daemon/service/runtime_folder.h"
#include "rig/rig_file.h"

namespace softgrip::daemon {

namespace {

using nlohmann::json;

constexpr int schema = 1;
/// Largest size of the copy [bytes]. The rig file and each board map and model have at most 256 KiB.
constexpr std::size_t largest = std::size_t{32} << 20U;

/// Returns the absolute path of a rig file, so that the result does not depend on the working directory.
std::string absolute(const std::string& config) {
  std::error_code error;
  const std::filesystem::path path = std::filesystem::absolute(config, error);
  return error ? config : path.lexically_normal().string();
}

std::string name_of(const std::string& config) {
  return "rig-" + sha256(absolute(config)) + ".json";
}

/// Returns the runtime folder. Returns nothing if the contents of this folder survive a restart of the
/// machine: after a restart, the state of the boards is unknown, so a copy of the rig must not be used.
std::optional<RuntimeFolder> folder() {
  auto opened = RuntimeFolder::open();
  if (!opened || !opened->ends_with_the_machine()) return std::nullopt;
  return std::move(*opened);
}

std::optional<std::vector<rig::InputFile>> files_of(const std::string& text, const std::string& config) {
  const json kept = json::parse(text, nullptr, false);
  if (!kept.is_object() || kept.value("schema", 0) != schema || kept.value("config", "") != absolute(config))
    return std::nullopt;
  std::vector<rig::InputFile> files;
  for (const json& file : kept.value("files", json::array())) {
    const int role = file.value("role", 0);
    if (role < 0 || role > static_cast<int>(rig::InputFile::Role::plant)) return std::nullopt;
    files.push_back(
        {static_cast<rig::InputFile::Role>(role), file.value("path", ""), file.value("text", "")});
  }
  return files;
}

}  // namespace

tl::expected<void, std::string> keep_rig(const rig::RigFile& rig) {
  if (driven_by(rig).empty() || rig.inputs.empty()) return {};
  const auto place = folder();
  if (!place) return tl::unexpected(std::string("this user has no folder in /run"));
  json kept{{"schema", schema}, {"config", absolute(rig.path)}, {"files", json::array()}};
  for (const rig::InputFile& file : rig.inputs)
    kept["files"].push_back(
        {{"role", static_cast<int>(file.role)}, {"path", file.path}, {"text", file.text}});
  return place->put(name_of(rig.path), kept.dump(-1, ' ', false, json::error_handler_t::replace));
}

std::optional<rig::RigFile> kept_rig(const std::string& config) {
  const auto place = folder();
  if (!place) return std::nullopt;
  const auto text = place->get(name_of(config), largest);
  if (!text) return std::nullopt;
  try {
    const auto files = files_of(*text, config);
    document::Problems ignored;
    return files ? rig::read_stored_rig(*files, ignored) : std::nullopt;
  } catch (const json::exception&) {  // a value in the JSON text has an unexpected type
    return std::nullopt;
  }
}

void forget_rig(const std::string& config) {
  if (const auto place = folder()) place->remove(name_of(config));
}

}  // namespace softgrip::daemon
