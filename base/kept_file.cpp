#include "base/kept_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "base/descriptor.h"
#include "base/errno_text.h"

namespace softgrip {

namespace {

/// All of it, to the disk; else errno says why.
bool write_through(int file, std::string_view contents) {
  while (!contents.empty()) {
    const ssize_t count = ::write(file, contents.data(), contents.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    contents.remove_prefix(static_cast<std::size_t>(count));
  }
  return ::fsync(file) == 0;
}

/// A new file with these permissions; nothing is left of it where that fails.
tl::expected<void, std::string> write_new(const std::string& path, std::string_view contents, mode_t mode) {
  const Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode));
  if (!file) return tl::unexpected(text_of_errno(errno));
  if (write_through(file.get(), contents)) return {};
  const int error = errno;
  ::unlink(path.c_str());
  return tl::unexpected(text_of_errno(error));
}

/// So that the name itself outlives a power failure, as far as the file system promises.
void sync_folder(const std::filesystem::path& path) {
  const std::string folder = path.has_parent_path() ? path.parent_path().string() : ".";
  const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened) ::fsync(opened.get());
}

}  // namespace

tl::expected<void, std::string> replace_file(const std::string& path, std::string_view contents) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  struct ::stat old {};
  if (error || ::stat(target.c_str(), &old) != 0) {
    return tl::unexpected("cannot replace " + path + ": " + (error ? error.message() : text_of_errno(errno)));
  }
  const std::string temporary = target.string() + ".part" + std::to_string(::getpid());
  if (const auto written = write_new(temporary, contents, 0600); !written) {
    return tl::unexpected("cannot write " + path + ": " + written.error());
  }
  // Who may not give the file to its owner keeps it for himself.
  [[maybe_unused]] const int given = ::chown(temporary.c_str(), old.st_uid, old.st_gid);
  if (::chmod(temporary.c_str(), old.st_mode & 07777U) != 0 ||
      ::rename(temporary.c_str(), target.c_str()) != 0) {
    const std::string reason = text_of_errno(errno);
    ::unlink(temporary.c_str());
    return tl::unexpected("cannot write " + path + ": " + reason);
  }
  sync_folder(target);
  return {};
}

tl::expected<void, std::string> create_file(const std::string& path, std::string_view contents) {
  if (const auto written = write_new(path, contents, 0666); !written) {
    return tl::unexpected("cannot create " + path + ": " + written.error());
  }
  sync_folder(path);
  return {};
}

}  // namespace softgrip
