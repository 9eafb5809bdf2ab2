#pragma once
// Reads regular files up to a maximum size. Writes files in such a way that a reader never sees an incomplete
// file.

#include <cstddef>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "base/descriptor.h"

namespace softgrip {

/// A regular file that was opened for reading, and its size.
struct RegularFile {
  Descriptor descriptor;
  std::size_t size = 0;  ///< size when the file was opened [bytes]
};

/// Opens a regular file for reading and follows symbolic links. The call never waits for another process: a
/// pipe, a device, a socket, a folder and a file that another process has leased are errors. The error is the
/// reason, without the path. Use this function for every file that another user or program can replace. The
/// file system itself can still block: a call on a network mount whose server does not respond does not
/// return.
[[nodiscard]] tl::expected<RegularFile, std::string> open_regular(const std::string& path);

/// Opens the regular file `name` in an open folder. Differs from open_regular() in one point: a symbolic link
/// is an error.
[[nodiscard]] tl::expected<RegularFile, std::string> open_regular_in(const Descriptor& folder,
                                                                     const std::string& name);

/// Returns the next `most` bytes of the file, or fewer bytes at the end of the file. The error is the reason.
[[nodiscard]] tl::expected<std::string, std::string> read_start(const RegularFile& file, std::size_t most);

/// Returns the contents of a regular file of at most `bound` bytes. The error is a sentence with the reason.
[[nodiscard]] tl::expected<std::string, std::string> read_file(const std::string& path, std::size_t bound);

/// Returns true if the path leads to a file or a folder; symbolic links are followed. is_there() and
/// is_folder() do not throw, unlike the functions of std::filesystem. They return false for an unreadable
/// folder or an invalid name.
[[nodiscard]] bool is_there(const std::string& path) noexcept;
[[nodiscard]] bool is_folder(const std::string& path) noexcept;

/// Returns true if both paths lead to the same file (device and inode), through symbolic and hard links.
[[nodiscard]] bool same_file(const std::string& one, const std::string& other) noexcept;

/// Durability of a written file. If a function below returns an error, `path` is unchanged. After a full
/// disk, a signal or a power failure, `path` contains either the complete old file or the complete new file.
/// The new file is written under another name in the same folder and then renamed. A killed process can leave
/// a file `.softgrip-*.part`. Errors are sentences.
enum class Sync {
  none,  ///< the kernel decides when it writes the file to the disk; after a power failure the file can be
         ///< empty
  disk,  ///< the file is written to the disk before it gets its name
};

/// Writes a file and creates missing folders. A new file replaces an existing file and gets its owner and
/// permissions. If `path` is a symbolic link, the new file replaces the link.
[[nodiscard]] tl::expected<void, std::string> write_file(const std::string& path, std::string_view contents,
                                                         Sync sync = Sync::disk);

/// Replaces the contents of a file that exists. If `path` is a symbolic link, the link remains, and the file
/// to which it leads is replaced.
[[nodiscard]] tl::expected<void, std::string> replace_file(const std::string& path,
                                                           std::string_view contents);

/// Writes a new file. If the file already exists, returns an error.
[[nodiscard]] tl::expected<void, std::string> create_file(const std::string& path, std::string_view contents);

/// Writes the file `name` of an open folder with mode 0600. The function does not wait until the file is on
/// the disk, because such files are not needed after a restart of the machine.
[[nodiscard]] tl::expected<void, std::string> write_private_file(const Descriptor& folder,
                                                                 const std::string& name,
                                                                 std::string_view contents);

/// Writes all bytes to an open descriptor. Returns 0, or the errno of the system call that failed.
[[nodiscard]] int write_all(int descriptor, std::string_view bytes) noexcept;

}  // namespace softgrip
