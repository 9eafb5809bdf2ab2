#pragma once
// The folder for what programs of softgrip leave for each other until the machine restarts: the locks of
// boards and the rig that runs. No other user can write there.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/descriptor.h"

namespace softgrip::daemon {

class RuntimeFolder {
 public:
  /// Opens /run/softgrip, which belongs to the service; root makes it where it is missing. A user who may not
  /// write there gets a folder of his own: /run/user/UID/softgrip, or /tmp/softgrip-UID. The error is a
  /// sentence.
  [[nodiscard]] static tl::expected<RuntimeFolder, std::string> open();
  /// Opens a folder among other places, in the order of preference.
  [[nodiscard]] static tl::expected<RuntimeFolder, std::string> open(const std::vector<std::string>& places);

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// True if a restart of the machine empties it.
  [[nodiscard]] bool ends_with_the_machine() const noexcept;

  /// Opens a file of the folder for reading and writing, and creates it if need be. It belongs to the
  /// folder's owner, who alone may open it. Links, other kinds of files and files that others could open are
  /// refused.
  [[nodiscard]] tl::expected<Descriptor, std::string> lock_file(const std::string& name) const;
  /// Puts a whole file in the place of `name` in one step. It has the rights of lock_file().
  [[nodiscard]] tl::expected<void, std::string> put(const std::string& name,
                                                    const std::string& contents) const;
  /// Returns the contents of a file that put() wrote, of at most `bound` bytes.
  [[nodiscard]] tl::expected<std::string, std::string> get(const std::string& name, std::size_t bound) const;
  /// Removes a file. One that is not there is no error.
  void remove(const std::string& name) const noexcept;
  /// True if `name` is the file that was opened.
  [[nodiscard]] bool still_names(const std::string& name, int opened) const noexcept;

 private:
  RuntimeFolder(std::string path, Descriptor folder) : path_(std::move(path)), folder_(std::move(folder)) {}
  [[nodiscard]] static tl::expected<RuntimeFolder, std::string> open_one(const std::string& place);
  [[nodiscard]] tl::expected<Descriptor, std::string> open_file(const std::string& name, int flags) const;

  std::string path_;
  Descriptor folder_;
};

}  // namespace softgrip::daemon
