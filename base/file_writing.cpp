// Implements the functions of base/files.h that create files and folders.

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>

#include "base/files.h"
#include "base/text.h"

namespace softgrip {
namespace {

namespace fs = std::filesystem;

/// Result of a function: 0, or the errno of the system call that failed.
using Error = int;

constexpr mode_t new_file_mode = 0666;  // permissions of a new file, before the umask removes some of them
constexpr mode_t private_mode = 0600;
constexpr mode_t permissions = 0777;

Error error_of(int result) {
  return result == 0 ? 0 : errno;
}

/// Returns a random name in the folder of `target`. No other process uses this name or can guess it.
std::string temporary_name(const fs::path& target) {
  std::uint64_t number = 0;
  // If getrandom() fails, the name can be guessed. O_EXCL in open() then prevents that two processes write to
  // one file.
  if (::getrandom(&number, sizeof number, GRND_NONBLOCK) < 0) number = static_cast<std::uint64_t>(::getpid());
  char name[48];
  (void)std::snprintf(name, sizeof name, ".softgrip-%016llx.part", static_cast<unsigned long long>(number));
  return (target.parent_path() / name).string();
}

/// Owner, group and permissions of a file.
struct Rights {
  uid_t owner = 0;
  gid_t group = 0;
  mode_t mode = 0;
};

/// Sets owner, group and permissions of a file. If the process may not change the owner, this is no error:
/// the user of the process remains the owner of the file.
Error give_rights(int file, const Rights& rights) {
  [[maybe_unused]] const int given = ::fchown(file, rights.owner, rights.group);
  return error_of(::fchmod(file, rights.mode));
}

/// Creates a file with the contents `contents` and the owner and permissions `rights`. If `rights` is empty,
/// the file gets the default permissions of this process.
Error write_new(int folder, const std::string& name, std::string_view contents,
                const std::optional<Rights>& rights, Sync sync) {
  Descriptor file(::openat(folder, name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                           rights ? private_mode : new_file_mode));
  if (!file) return errno;
  Error error = write_all(file.get(), contents);
  if (error == 0 && rights) error = give_rights(file.get(), *rights);
  if (error == 0 && sync == Sync::disk) error = error_of(::fsync(file.get()));
  // On a network file system, close() can be the first call that reports a full disk.
  const Error closed = error_of(::close(file.release()));
  return error != 0 ? error : closed;
}

/// Renames a file. Returns EEXIST if a file with the new name already exists.
Error rename_to_new(int folder, const char* from, const char* to) {
  const Error error = error_of(::renameat2(folder, from, folder, to, RENAME_NOREPLACE));
  if (error != EINVAL) return error;
  // NFS does not support RENAME_NOREPLACE. A hard link with the new name has the same effect.
  const Error linked = error_of(::linkat(folder, from, folder, to, 0));
  return linked != 0 ? linked : error_of(::unlinkat(folder, from, 0));
}

/// Writes the entries of a folder to the disk, so that the names of its files survive a power failure.
void sync_folder(const fs::path& folder) {
  const Descriptor opened(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (opened) ::fsync(opened.get());
}

enum class Existing { replaced, refused };

/// Creates or replaces a file. All functions of base/files.h that write a complete file call put(). `target`
/// is relative to the descriptor `folder`, or to the working directory if `folder` is AT_FDCWD.
Error put(int folder, const fs::path& target, std::string_view contents, Existing existing,
          const std::optional<Rights>& rights, Sync sync) {
  const std::string temporary = temporary_name(target);
  Error error = write_new(folder, temporary, contents, rights, sync);
  if (error == 0) {
    error = existing == Existing::replaced
                ? error_of(::renameat(folder, temporary.c_str(), folder, target.c_str()))
                : rename_to_new(folder, temporary.c_str(), target.c_str());
  }
  if (error != 0) ::unlinkat(folder, temporary.c_str(), 0);
  return error;
}

/// Writes a file at a path with put(). If the new file replaces an existing file, the new file gets the owner
/// and the permissions of the existing file.
Error put_at_path(const fs::path& target, std::string_view contents, Existing existing, Sync sync) {
  struct ::stat old {};
  std::optional<Rights> rights;
  if (::lstat(target.c_str(), &old) == 0 && S_ISREG(old.st_mode))
    rights = Rights{old.st_uid, old.st_gid, old.st_mode & permissions};
  const Error error = put(AT_FDCWD, target, contents, existing, rights, sync);
  if (error == 0 && sync == Sync::disk) sync_folder(target.parent_path());
  return error;
}

tl::expected<void, std::string> ended(Error error, const char* verb, const std::string& path) {
  if (error == 0) return {};
  return tl::unexpected(std::string("cannot ") + verb + " " + path + ": " + text_of_errno(error));
}

}  // namespace

int write_all(int descriptor, std::string_view bytes) noexcept {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    if (count == 0) return ENOSPC;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return 0;
}

tl::expected<void, std::string> write_file(const std::string& path, std::string_view contents, Sync sync) {
  const fs::path target(path);
  std::error_code error;
  if (target.has_parent_path()) fs::create_directories(target.parent_path(), error);
  if (error) return tl::unexpected("cannot create " + target.parent_path().string() + ": " + error.message());
  return ended(put_at_path(target, contents, Existing::replaced, sync), "write", path);
}

tl::expected<void, std::string> replace_file(const std::string& path, std::string_view contents) {
  std::error_code error;
  const fs::path target = fs::canonical(path, error);
  if (error) return tl::unexpected("cannot replace " + path + ": " + error.message());
  return ended(put_at_path(target, contents, Existing::replaced, Sync::disk), "write", path);
}

tl::expected<void, std::string> create_file(const std::string& path, std::string_view contents) {
  return ended(put_at_path(path, contents, Existing::refused, Sync::disk), "create", path);
}

tl::expected<void, std::string> write_private_file(const Descriptor& folder, const std::string& name,
                                                   std::string_view contents) {
  struct ::stat owner {};
  Error error = error_of(::fstat(folder.get(), &owner));
  if (error == 0) {
    const Rights rights{owner.st_uid, owner.st_gid, private_mode};
    error = put(folder.get(), name, contents, Existing::replaced, rights, Sync::none);
  }
  return ended(error, "write", name);
}

}  // namespace softgrip
