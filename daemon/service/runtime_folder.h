#pragma once
// The folder for data that softgrip programs share until the machine restarts: the locks of boards and the
// running rig. No other user can write there.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/descriptor.h"

namespace softgrip::daemon {

class RuntimeFolder {
 public:
  /// Opens /run/softgrip, which belongs to the service; root creates it if it is missing. A user without
  /// write permission gets an own folder: /run/user/UID/softgrip, or /tmp/softgrip-UID. The error is a
  /// sentence.
  [[nodiscard]] static tl::expected<RuntimeFolder, std::string> open();
  /// Opens the first usable folder of a list, in the order of preference.
  [[nodiscard]] static tl::expected<RuntimeFolder, std::string> open(const std::vector<std::string>& places);

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// Returns true if a restart of the machine removes the contents.
  [[nodiscard]] bool ends_with_the_machine() const noexcept;

  /// Opens a file of the folder for reading and writing, and creates it if necessary. The file belongs to the
  /// folder's owner, and only the owner may open it. Links, other kinds of files, and files with other
  /// permissions are refused.
  [[nodiscard]] tl::expected<Descriptor, std::string> lock_file(const std::string& name) const;
  /// Replaces the file `name` in one step. The file has the permissions of lock_file().
  [[nodiscard]] tl::expected<void, std::string> put(const std::string& name,
                                                    const std::string& contents) const;
  /// Returns the contents of a file that put() wrote, of at most `bound` bytes.
  [[nodiscard]] tl::expected<std::string, std::string> get(const std::string& name, std::size_t bound) const;
  /// Removes a file. A missing file is not an error.
  void remove(const std::string& name) const noexcept;
  /// Returns true if `name` still leads to the opened file.
  [[nodiscard]] bool still_names(const std::string& name, int opened) const noexcept;

 private:
  RuntimeFolder(std::string path, Descriptor folder) : path_(std::move(path)), folder_(std::move(folder)) {}
  [[nodiscard]] static tl::expected<RuntimeFolder, std::string> open_one(const std::string& place);
  [[nodiscard]] tl::expected<Descriptor, std::string> open_file(const std::string& name, int flags) const;

  std::string path_;
  Descriptor folder_;
};

}  // namespace softgrip::daemon
