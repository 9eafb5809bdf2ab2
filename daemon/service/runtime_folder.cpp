#include "daemon/service/runtime_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "base/json.h"
#include "base/sha256.h"
#include "base/text.h"
#include "daemon/service/board_lock.h"
#include "daemon/service/trusted_user.h"

namespace softgrip::daemon {
namespace {

constexpr const char* service_folder = "/run/softgrip";
constexpr mode_t others_may_write = S_IWGRP | S_IWOTH;
constexpr mode_t others_may_do_anything = S_IRWXG | S_IRWXO;

using Failure = tl::unexpected<std::string>;

Failure failure(const std::string& path, std::string_view what) {
  return Failure(fmt::format("{}: {}: {}", path, what, text_of_errno(errno)));
}

std::vector<std::string> usual_places() {
  const std::string user = std::to_string(::geteuid());
  return {service_folder, "/run/user/" + user + "/softgrip", "/tmp/softgrip-" + user};
}

/// Creates the folder if it is missing. The folder of the service always belongs to the service user, even if
/// root creates the folder.
void make(const std::string& place) {
  const bool of_service = place == service_folder;
  if (::mkdir(place.c_str(), of_service ? 0755 : 0700) != 0 || !of_service) return;
  const std::optional<uid_t> user = service_user();
  // On a machine without the service user, the service is not installed, so root remains the owner of the
  // folder.
  if (user) [[maybe_unused]]
    const int given = ::chown(place.c_str(), *user, static_cast<gid_t>(-1));
}

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

tl::expected<RuntimeFolder, std::string> RuntimeFolder::open_one(const std::string& place) {
  make(place);
  Descriptor folder(::open(place.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
  struct stat status {};
  if (!folder || ::fstat(folder.get(), &status) != 0) return failure(place, "cannot be opened");
  if (!is_trusted(status.st_uid))
    return Failure(fmt::format("{}: this folder belongs to user {}", place, status.st_uid));
  if ((status.st_mode & others_may_write) != 0)
    return Failure(place + ": other users may write to this folder");
  if (::faccessat(folder.get(), ".", W_OK | X_OK, AT_EACCESS) != 0)
    return failure(place, "cannot be written");
  return RuntimeFolder(place, std::move(folder));
}

tl::expected<RuntimeFolder, std::string> RuntimeFolder::open(const std::vector<std::string>& places) {
  std::string why;
  for (const std::string& place : places) {
    auto folder = open_one(place);
    if (folder) return folder;
    why += (why.empty() ? "" : "; ") + folder.error();
  }
  return Failure(std::move(why));
}

tl::expected<RuntimeFolder, std::string> RuntimeFolder::open() {
  return open(usual_places());
}

bool RuntimeFolder::ends_with_the_machine() const noexcept {
  return path_.starts_with("/run/");
}

tl::expected<Descriptor, std::string> RuntimeFolder::open_file(const std::string& name, int flags) const {
  constexpr int always = O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
  const std::string path = path_ + "/" + name;
  Descriptor file(::openat(folder_.get(), name.c_str(), flags | always, 0600));
  struct stat status {};
  struct stat folder {};
  if (!file || ::fstat(file.get(), &status) != 0 || ::fstat(folder_.get(), &folder) != 0)
    return failure(path, "cannot be opened");
  if (!S_ISREG(status.st_mode)) return Failure(path + ": not a regular file");
  if (!is_trusted(status.st_uid) || (status.st_mode & others_may_do_anything) != 0 || status.st_nlink != 1)
    return Failure(path + ": other users could open this file");
  // A file that root creates must also belong to the service user. Only root can change the owner.
  if (status.st_uid != folder.st_uid && (flags & O_CREAT) != 0) [[maybe_unused]]
    const int given = ::fchown(file.get(), folder.st_uid, folder.st_gid);
  return file;
}

tl::expected<Descriptor, std::string> RuntimeFolder::lock_file(const std::string& name) const {
  return open_file(name, O_RDWR | O_CREAT);
}

tl::expected<void, std::string> RuntimeFolder::put(const std::string& name,
                                                   const std::string& contents) const {
  if (auto written = write_private_file(folder_, name, contents); !written)
    return Failure(fmt::format("{}: {}", path_, written.error()));
  return {};
}

tl::expected<std::string, std::string> RuntimeFolder::get(const std::string& name, std::size_t bound) const {
  auto file = open_file(name, O_RDONLY);
  if (!file) return Failure(file.error());
  auto contents = read_start({std::move(*file), 0}, bound + 1);
  if (!contents) return Failure(fmt::format("{}/{}: cannot be read: {}", path_, name, contents.error()));
  if (contents->size() > bound)
    return Failure(fmt::format("{}/{}: has more than {} bytes", path_, name, bound));
  return contents;
}

void RuntimeFolder::remove(const std::string& name) const noexcept {
  ::unlinkat(folder_.get(), name.c_str(), 0);
}

bool RuntimeFolder::still_names(const std::string& name, int opened) const noexcept {
  struct stat there {};
  struct stat mine {};
  return ::fstatat(folder_.get(), name.c_str(), &there, AT_SYMLINK_NOFOLLOW) == 0 &&
         ::fstat(opened, &mine) == 0 && there.st_dev == mine.st_dev && there.st_ino == mine.st_ino;
}

tl::expected<void, std::string> keep_rig(const rig::RigFile& rig) {
  if (driven_by(rig).empty() || rig.inputs.empty()) return {};
  const auto place = folder();
  if (!place) return tl::unexpected(std::string("this user has no folder in /run"));
  json kept{{"schema", schema}, {"config", absolute(rig.path)}, {"files", json::array()}};
  for (const rig::InputFile& file : rig.inputs)
    kept["files"].push_back(
        {{"role", static_cast<int>(file.role)}, {"path", file.path}, {"text", file.text}});
  return place->put(name_of(rig.path), json_dump(kept));
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
