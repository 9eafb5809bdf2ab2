#pragma once
// Files: regular ones, read with a bound, and written so that a reader never finds half of one.

#include <cstddef>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "base/descriptor.h"

namespace softgrip {

/// A regular file that is open for reading.
struct RegularFile {
  Descriptor descriptor;
  std::size_t size = 0;  ///< [bytes] when it was opened
};

/// Opens a regular file for reading, through links. It never waits for another process: a pipe, a device, a
/// socket, a folder and a file that another process has leased are errors. The error is the reason, without
/// the path. Use it for every file that another user or program can replace. The file system itself can still
/// block: a network mount whose server does not respond holds every call on it.
[[nodiscard]] tl::expected<RegularFile, std::string> open_regular(const std::string& path);

/// Opens the regular file `name` of an open folder as open_regular() does. A symbolic link is an error.
[[nodiscard]] tl::expected<RegularFile, std::string> open_regular_in(const Descriptor& folder,
                                                                     const std::string& name);

/// Returns the next `most` bytes of the file, or fewer where it ends. The error is the reason.
[[nodiscard]] tl::expected<std::string, std::string> read_start(const RegularFile& file, std::size_t most);

/// The bytes of a regular file of at most `bound` bytes, or a sentence that says why not.
[[nodiscard]] tl::expected<std::string, std::string> read_file(const std::string& path, std::size_t bound);

/// True if there is a file or folder of this path, through links. Unlike those of std::filesystem these two
/// do not throw: an unreadable folder or an impossible name is no file.
[[nodiscard]] bool is_there(const std::string& path) noexcept;
[[nodiscard]] bool is_folder(const std::string& path) noexcept;

/// True if both paths lead to one file: same device and inode, through symbolic and hard links.
[[nodiscard]] bool same_file(const std::string& one, const std::string& other) noexcept;

/// The writing of a file. Each function below leaves `path` as it was unless it returns a value: a reader, a
/// full disk, a signal and a power failure find the old file or the new one, never a part. The new file is
/// written under another name in the same folder and takes the old one's place by a rename. A new name of a
/// killed process, `.softgrip-*.part`, can stay behind. Errors are sentences.
enum class Sync {
  none,  ///< the kernel writes it when it likes: after a power failure the file can be empty
  disk,  ///< the file has reached the disk before it gets its name
};

/// Writes a result. Creates missing folders. A file that exists is replaced and keeps its owner and
/// permissions; a symbolic link is replaced by the file.
[[nodiscard]] tl::expected<void, std::string> write_file(const std::string& path, std::string_view contents,
                                                         Sync sync = Sync::disk);

/// Replaces the contents of a file that must exist. A symbolic link stays one.
[[nodiscard]] tl::expected<void, std::string> replace_file(const std::string& path,
                                                           std::string_view contents);

/// Writes a file that must not exist yet.
[[nodiscard]] tl::expected<void, std::string> create_file(const std::string& path, std::string_view contents);

/// Writes the file `name` of an open folder, for its owner alone: mode 0600. It is not forced to the disk,
/// because such files end with the machine.
[[nodiscard]] tl::expected<void, std::string> write_private_file(const Descriptor& folder,
                                                                 const std::string& name,
                                                                 std::string_view contents);

/// Writes all bytes to an open descriptor. Returns 0, or the errno of the call that failed.
[[nodiscard]] int write_all(int descriptor, std::string_view bytes) noexcept;

}  // namespace softgrip
