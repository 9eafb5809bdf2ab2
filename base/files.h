#pragma once
// Reads regular files up to a maximum size. Writes files such that a reader never sees an incomplete file.
// Creates a temporary folder.

#include <cstddef>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

#include "base/descriptor.h"

namespace softgrip {

/// A regular file that was opened for reading, with its size.
struct RegularFile {
  Descriptor descriptor;
  std::size_t size = 0;  ///< size of the file when it was opened [bytes]
};

/// Opens a regular file for reading and follows symbolic links. The call never waits for another process.
/// Therefore, a pipe, a device, a socket, a folder and a file that another process has leased are errors. The
/// error is a text with the reason, without the path. Use this function for every file that another user or
/// program can replace. However, the file system can block: on a network mount whose server does not respond,
/// the call does not return.
[[nodiscard]] tl::expected<RegularFile, std::string> open_regular(const std::string& path);

/// Opens the regular file `name` in an open folder, as open_regular() does. However, a symbolic link is an
/// error.
[[nodiscard]] tl::expected<RegularFile, std::string> open_regular_in(const Descriptor& folder,
                                                                     const std::string& name);

/// Returns the next `most` bytes of the file, or fewer bytes at the end of the file. The error is a text with
/// the reason.
[[nodiscard]] tl::expected<std::string, std::string> read_start(const RegularFile& file, std::size_t most);

/// Returns the contents of a regular file of at most `bound` bytes. The error is a sentence with the reason.
[[nodiscard]] tl::expected<std::string, std::string> read_file(const std::string& path, std::size_t bound);

/// is_there() returns true if the path leads to anything that exists, and is_folder() if it leads to a
/// folder. Symbolic links are followed. Unlike the functions of std::filesystem, these two functions do not
/// throw exceptions. They return false for an unreadable folder or an invalid name.
[[nodiscard]] bool is_there(const std::string& path) noexcept;
[[nodiscard]] bool is_folder(const std::string& path) noexcept;

/// Returns the path without "." and "..", and without a separator at the end.
[[nodiscard]] std::string plain_path(const std::string& path);

/// Returns the name of the folder or file to which a path leads: the last component of plain_path().
[[nodiscard]] std::string name_in_path(const std::string& path);

/// Returns "" if `path` is a folder or a regular file that can be opened for reading. Otherwise returns the
/// reason why it cannot be read.
[[nodiscard]] std::string why_unreadable(const std::string& path);

/// Returns true if both paths lead to the same file (device and inode), through symbolic and hard links.
[[nodiscard]] bool same_file(const std::string& one, const std::string& other) noexcept;

/// Durability of a written file. If a write function returns an error, the file at `path` is unchanged. After
/// a full disk, a signal or a power failure, `path` contains either the complete old file or the complete new
/// file. The new file is first written under a temporary name in the folder of `path`, and then renamed. A
/// process that is killed can leave a file `.softgrip-*.part`. Each error is a sentence.
enum class Sync {
  none,  ///< the kernel decides when it writes the file to the disk; a power failure can leave an empty file
  disk,  ///< the file is written to the disk before it gets its final name
};

/// Writes a file and creates missing folders. If a file already exists at `path`, the new file replaces the
/// existing file and gets the owner and the permissions of the existing file. If `path` is a symbolic link,
/// the new file replaces the link.
[[nodiscard]] tl::expected<void, std::string> write_file(const std::string& path, std::string_view contents,
                                                         Sync sync = Sync::disk);

/// Replaces the contents of an existing file. If `path` is a symbolic link, the link remains, and the file to
/// which it leads is replaced.
[[nodiscard]] tl::expected<void, std::string> replace_file(const std::string& path,
                                                           std::string_view contents);

/// Writes a new file. If the file already exists, returns an error.
[[nodiscard]] tl::expected<void, std::string> create_file(const std::string& path, std::string_view contents);

/// Writes the file `name` in an open folder with the permissions 0600. The function does not wait until the
/// file is on the disk, because private files are not needed after a restart of the machine.
[[nodiscard]] tl::expected<void, std::string> write_private_file(const Descriptor& folder,
                                                                 const std::string& name,
                                                                 std::string_view contents);

/// Writes all bytes to an open descriptor. Returns 0, or the errno of the system call that failed.
[[nodiscard]] int write_all(int descriptor, std::string_view bytes) noexcept;

/// A new folder for temporary files. The destructor removes the folder. path() returns an empty text if the
/// folder could not be created.
class ScratchFolder {
 public:
  ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ScratchFolder(ScratchFolder&&) = delete;
  ScratchFolder& operator=(ScratchFolder&&) = delete;
  ~ScratchFolder();

  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  std::string path_;
};

}  // namespace softgrip
