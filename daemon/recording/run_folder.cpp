#include "daemon/recording/run_folder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/files.h"

namespace softgrip::daemon {

namespace {

constexpr mode_t file_mode = 0644;
constexpr mode_t folder_mode = 0777;  // as in std::filesystem::create_directories()
/// Space that is reserved beyond the required space, so that few calls reserve space [bytes].
constexpr std::int64_t more_room = 256 * 1024;

std::string sentence(const std::string& what, int error) {
  return fmt::format("{}: {}", what, std::strerror(error));
}

std::string csv_in(const std::string& path) {
  return path + "/run.csv";
}

std::string there_already(const std::string& csv) {
  return csv + " exists already; a recording is never overwritten";
}

}  // namespace

std::string recorded_already(const std::string& path) {
  std::error_code ignored;
  if (path.empty() || !std::filesystem::exists(csv_in(path), ignored)) return {};
  return there_already(csv_in(path));
}

std::string why_unrecordable(const std::string& path) {
  namespace fs = std::filesystem;
  if (path.empty()) return {};
  std::error_code ignored;
  fs::path missing;  // the first folder in the path that does not exist
  for (fs::path at = plain_path(path); !at.empty() && !fs::exists(fs::symlink_status(at, ignored));
       at = at.parent_path())
    missing = at;
  int error = 0;
  if (!missing.empty()) {
    if (mkdir(missing.c_str(), folder_mode) == 0)
      rmdir(missing.c_str());
    else
      error = errno;
  } else if (!is_folder(path)) {
    error = ENOTDIR;
  } else if (access(path.c_str(), W_OK | X_OK) != 0) {
    error = errno;
  }
  return error == 0 ? std::string() : sentence("nothing can be recorded in " + path, error);
}

tl::expected<RunFolder, std::string> RunFolder::create(const std::string& path, std::string_view header,
                                                       bool durable) {
  std::error_code error;
  const bool created = std::filesystem::create_directories(path, error);
  if (error) return tl::unexpected(fmt::format("{}: {}", path, error.message()));
  const std::string file = csv_in(path);
  const int descriptor = open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, file_mode);
  if (descriptor < 0 && errno == EEXIST) return tl::unexpected(there_already(file));
  if (descriptor < 0) {
    const int reason = errno;
    if (created) rmdir(path.c_str());
    return tl::unexpected(sentence(file, reason));
  }
  RunFolder folder(path, descriptor, durable);
  if (!folder.append(header)) {
    unlink(file.c_str());
    if (created) rmdir(path.c_str());
    return tl::unexpected(folder.error());
  }
  return folder;
}

RunFolder::RunFolder(RunFolder&& other) noexcept
    : path_(std::move(other.path_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      durable_(other.durable_),
      whole_bytes_(other.whole_bytes_),
      reserved_bytes_(std::exchange(other.reserved_bytes_, 0)),
      error_(std::move(other.error_)),
      json_error_(std::move(other.json_error_)) {}

RunFolder& RunFolder::operator=(RunFolder&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(durable_, other.durable_);
  std::swap(whole_bytes_, other.whole_bytes_);
  std::swap(reserved_bytes_, other.reserved_bytes_);
  std::swap(error_, other.error_);
  std::swap(json_error_, other.json_error_);
  return *this;
}

RunFolder::~RunFolder() {
  close();
}

/// Reserves the space of run.csv up to the byte `end`. Returns 0, or the errno that means that the disk is
/// full. Other errors are ignored, because the write also works without reserved space.
int RunFolder::reserve(std::int64_t end) noexcept {
  if (end <= reserved_bytes_) return 0;
  for (const std::int64_t more : {more_room, std::int64_t{0}}) {
    if (fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, reserved_bytes_, end + more - reserved_bytes_) == 0) {
      reserved_bytes_ = end + more;
      return 0;
    }
    if (errno != ENOSPC && errno != EDQUOT) return 0;
  }
  return errno;
}

void RunFolder::release_room() noexcept {
  if (reserved_bytes_ == 0) return;
  // If this truncation fails, the space remains reserved. run.json may then not be replaced on a full disk.
  [[maybe_unused]] const int released = ftruncate(descriptor_, whole_bytes_);
  reserved_bytes_ = 0;
}

void RunFolder::close() noexcept {
  release_room();
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

void RunFolder::fail(const std::string& what, int error) {
  if (error_.empty()) error_ = sentence(what, error);
}

bool RunFolder::append(std::string_view lines, std::size_t room) {
  if (descriptor_ < 0) return false;
  int error = reserve(whole_bytes_ + static_cast<std::int64_t>(lines.size() + room));
  if (error == 0) error = write_all(descriptor_, lines);
  if (error == 0) {
    whole_bytes_ += static_cast<std::int64_t>(lines.size());
    return true;
  }
  fail(path_ + "/run.csv", error);
  // If the disk is full, a part of the lines may have been written. Truncation removes this part and needs no
  // space. If the truncation fails, the last line is incomplete, which readers of recordings accept.
  if (ftruncate(descriptor_, whole_bytes_) != 0) error_ += "; the last line of run.csv may be incomplete";
  close();
  return false;
}

bool RunFolder::sync() {
  if (descriptor_ < 0) return false;
  if (fdatasync(descriptor_) == 0) return true;
  // After a failed fdatasync(), the kernel discards the pages, so the contents of the file on the disk are
  // unknown. No more rows are written.
  fail(path_ + "/run.csv", errno);
  close();
  return false;
}

bool RunFolder::replace_json(std::string_view text) {
  const auto written = write_file(path_ + "/run.json", text, durable_ ? Sync::disk : Sync::none);
  json_error_ = written ? std::string() : written.error();
  return written.has_value();
}

}  // namespace softgrip::daemon
