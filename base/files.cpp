#include "base/files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "base/text.h"

namespace softgrip {
namespace {

using Failure = tl::unexpected<std::string>;

Failure reason(int error) {
  return Failure(text_of_errno(error));
}

Failure not_regular(mode_t mode) {
  if (S_ISDIR(mode)) return reason(EISDIR);
  const char* const kind = S_ISFIFO(mode)   ? "a pipe"
                           : S_ISSOCK(mode) ? "a socket"
                           : S_ISLNK(mode)  ? "a symbolic link"
                                            : "a device";
  return Failure(std::string("it is ") + kind + ", not a regular file");
}

/// Opens a regular file for reading. `name` is relative to the descriptor `folder`, or to the working
/// directory if `folder` is AT_FDCWD.
tl::expected<RegularFile, std::string> open_at(int folder, const std::string& name, bool through_links) {
  struct ::stat about {};
  // The type of the file is checked before the file is opened, because opening alone starts some devices,
  // such as a watchdog timer.
  if (::fstatat(folder, name.c_str(), &about, through_links ? 0 : AT_SYMLINK_NOFOLLOW) != 0)
    return reason(errno);
  if (!S_ISREG(about.st_mode)) return not_regular(about.st_mode);
  const int links = through_links ? 0 : O_NOFOLLOW;
  RegularFile file{
      Descriptor(::openat(folder, name.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC | links)), 0};
  if (!file.descriptor || ::fstat(file.descriptor.get(), &about) != 0) return reason(errno);
  // The type is checked a second time, because another process may have replaced the file after the first
  // check.
  if (!S_ISREG(about.st_mode)) return not_regular(about.st_mode);
  file.size = static_cast<std::size_t>(about.st_size);
  return file;
}

/// Reads at most `size` bytes from a descriptor. Returns the number of bytes that were read, or 0 at the end
/// of the file. Returns -1 after an error and sets errno.
ssize_t read_some(int descriptor, char* bytes, std::size_t size) {
  ssize_t count = 0;
  do {
    count = ::read(descriptor, bytes, size);
  } while (count < 0 && errno == EINTR);
  return count;
}

}  // namespace

tl::expected<RegularFile, std::string> open_regular(const std::string& path) {
  return open_at(AT_FDCWD, path, true);
}

tl::expected<RegularFile, std::string> open_regular_in(const Descriptor& folder, const std::string& name) {
  return open_at(folder.get(), name, false);
}

tl::expected<std::string, std::string> read_start(const RegularFile& file, std::size_t most) {
  // `file.size` is only used to reserve memory, because a file can grow during the read, and files in /proc
  // have the size 0.
  std::string contents;
  contents.reserve(std::min(file.size, most));
  std::string chunk(std::size_t{1} << 16, '\0');
  while (contents.size() < most) {
    const std::size_t wanted = std::min(chunk.size(), most - contents.size());
    const ssize_t count = read_some(file.descriptor.get(), chunk.data(), wanted);
    if (count < 0) return reason(errno);
    if (count == 0) break;
    contents.append(chunk, 0, static_cast<std::size_t>(count));
  }
  return contents;
}

bool is_there(const std::string& path) noexcept {
  struct ::stat about {};
  return ::stat(path.c_str(), &about) == 0;
}

bool is_folder(const std::string& path) noexcept {
  struct ::stat about {};
  return ::stat(path.c_str(), &about) == 0 && S_ISDIR(about.st_mode);
}

bool same_file(const std::string& one, const std::string& other) noexcept {
  struct ::stat first {};
  struct ::stat second {};
  return ::stat(one.c_str(), &first) == 0 && ::stat(other.c_str(), &second) == 0 &&
         first.st_dev == second.st_dev && first.st_ino == second.st_ino;
}

tl::expected<std::string, std::string> read_file(const std::string& path, std::size_t bound) {
  const auto file = open_regular(path);
  if (!file) return Failure("cannot open " + path + ": " + file.error());
  const Failure too_large(path + " is larger than " + std::to_string(bound) + " bytes");
  if (file->size > bound) return too_large;
  auto contents = read_start(*file, bound + 1);
  if (!contents) return Failure("cannot read " + path + ": " + contents.error());
  if (contents->size() > bound) return too_large;
  return contents;
}

namespace fs = std::filesystem;

std::string plain_path(const std::string& path) {
  const fs::path normal = fs::path(path).lexically_normal();
  return (normal.has_filename() ? normal : normal.parent_path()).string();
}

std::string name_in_path(const std::string& path) {
  return fs::path(plain_path(path)).filename().string();
}

std::string why_unreadable(const std::string& path) {
  if (is_folder(path)) return ::access(path.c_str(), R_OK) == 0 ? std::string() : text_of_errno(errno);
  const auto file = open_regular(path);
  return file ? std::string() : file.error();
}

ScratchFolder::ScratchFolder() {
  std::error_code none;
  const fs::path temporary = fs::temp_directory_path(none);
  if (none) return;
  path_ = (temporary / "softgrip-XXXXXX").string();
  if (::mkdtemp(path_.data()) == nullptr) path_.clear();
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  if (!path_.empty()) fs::remove_all(path_, ignored);
}

}  // namespace softgrip
