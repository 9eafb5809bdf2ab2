#pragma once
// Manages the folder for data that softgrip programs share until the machine restarts: the locks of boards,
// and the copy of the rig file of the running daemon. No other user can write to this folder. Keeps a copy of
// softgripd's rig file in the runtime folder while softgripd runs. After a crash, the copy ensures that the
// safe outputs do not depend on later edits of the rig file.

#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "rig/rig_file.h"

namespace softgrip::daemon {

class RuntimeFolder {
 public:
  /// Opens /run/softgrip, which belongs to the service. If the folder is missing and the user is root,
  /// creates it. A user who cannot write to the folder gets a folder of his own: /run/user/UID/softgrip, or
  /// /tmp/softgrip-UID. The error is a sentence.
  [[nodiscard]] static tl::expected<RuntimeFolder, std::string> open();
  /// Opens the first usable folder of a list that is in the order of preference.
  [[nodiscard]] static tl::expected<RuntimeFolder, std::string> open(const std::vector<std::string>& places);

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// Returns true if a restart of the machine removes the contents of the folder.
  [[nodiscard]] bool ends_with_the_machine() const noexcept;

  /// Opens a file of the folder for reading and writing; if the file is missing, creates it. The file belongs
  /// to the folder's owner, and only this owner may open it. Links, other kinds of files, and files with
  /// other permissions are refused.
  [[nodiscard]] tl::expected<Descriptor, std::string> lock_file(const std::string& name) const;
  /// Replaces the file `name` in one step. The file gets the permissions that lock_file() gives.
  [[nodiscard]] tl::expected<void, std::string> put(const std::string& name,
                                                    const std::string& contents) const;
  /// Returns the contents of a file that put() wrote, of at most `bound` bytes.
  [[nodiscard]] tl::expected<std::string, std::string> get(const std::string& name, std::size_t bound) const;
  /// Removes a file. A missing file is not an error.
  void remove(const std::string& name) const noexcept;
  /// Returns true if `name` is still the name of the opened file. Returns false if the file was removed or
  /// replaced.
  [[nodiscard]] bool still_names(const std::string& name, int opened) const noexcept;

 private:
  RuntimeFolder(std::string path, Descriptor folder) : path_(std::move(path)), folder_(std::move(folder)) {}
  [[nodiscard]] static tl::expected<RuntimeFolder, std::string> open_one(const std::string& place);
  [[nodiscard]] tl::expected<Descriptor, std::string> open_file(const std::string& name, int flags) const;

  std::string path_;
  Descriptor folder_;
};

/// Copies the rig file and all files that it names into one file of the runtime folder, in one step. The new
/// copy replaces the copy of an earlier run with the same rig file. Does nothing for a rig that has no real
/// board. The error is a sentence.
[[nodiscard]] tl::expected<void, std::string> keep_rig(const rig::RigFile& rig);

/// Returns the rig that the last softgripd with the rig file `config` used. Returns nothing if that softgripd
/// ended in order with all outputs at rest, or if the copy cannot be read.
[[nodiscard]] std::optional<rig::RigFile> kept_rig(const std::string& config);

/// Removes the copy of the rig. Call this function after the board has confirmed that all outputs are at
/// rest.
void forget_rig(const std::string& config);

}  // namespace softgrip::daemon
