#pragma once
// Lists the daemon's recordings that browsers may see, and opens their files. Checks every name that a
// browser sends.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/descriptor.h"
#include "base/files.h"
#include "base/time.h"

namespace softgrip::web {

/// Returns true if `name` may be the name of a recording or of a file in a recording. A permitted name has at
/// most 128 letters, digits, ".", "-" and "_", and does not begin with a dot.
[[nodiscard]] bool is_plain_name(std::string_view name);

/// Returns the content type of a file that may be shown, for example "image/svg+xml"; "" for any other file.
[[nodiscard]] std::string_view content_type_of(std::string_view name);

/// Lists and opens recordings. All functions must be called from one thread.
class Recordings {
 public:
  static constexpr std::size_t most_listed = 200;
  /// Largest number of folders that are read for a list, beginning with the newest folder. If too few of
  /// these folders contain a file that may be shown, the list is shorter than `most_listed`. This limit
  /// bounds the memory and the time for a list, even if there are many more folders.
  static constexpr std::size_t most_considered = 2000;
  static constexpr std::size_t largest_file = std::size_t{16} << 20U;

  /// Stores the path of the folder and does not read the folder. An empty `folder` means that there are no
  /// recordings.
  explicit Recordings(std::string folder) : folder_(std::move(folder)) {}

  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }
  /// Returns the list of recordings, newest first. Each element has a `name` and the `files` that may be
  /// shown. Reads only the folders that have changed since the last call.
  /// @param wall_now  the result of wall_time_now(). A folder that changed just before this time is read
  /// again by the next call, because its time stamp may not show a second change.
  /// @param on_interval   is called between the folders; may be empty.
  [[nodiscard]] nlohmann::ordered_json list(Nanoseconds wall_now,
                                            const std::function<void()>& on_interval = {});
  /// Opens a file of a recording. Returns nullopt if the file does not exist or may not be shown. Follows no
  /// links.
  [[nodiscard]] std::optional<RegularFile> open(std::string_view recording, std::string_view file) const;
  /// Returns the number of folders that were read from the disk since the start.
  [[nodiscard]] std::size_t folders_read() const noexcept { return folders_read_; }

 private:
  /// The identity and the modification time of a folder, from stat().
  struct Stamp {
    std::uint64_t device = 0;
    std::uint64_t number = 0;
    Nanoseconds changed_at = 0;
    bool operator==(const Stamp&) const = default;
  };
  struct Names {
    Stamp stamp;
    bool stamp_reliable =
        false;  // true: any change of the folder after this stamp changes the folder's time stamp
    std::vector<std::string> names;
  };
  /// Determines which names of a folder are stored, and in which order.
  struct NameSelection {
    bool (*is_wanted)(std::string_view name) = nullptr;
    bool last_first = false;
    std::size_t most = 0;
  };

  void refresh(Names& known, const Descriptor& parent, const std::string& name,
               const NameSelection& selection);
  bool read_names(Descriptor folder, const NameSelection& selection, std::vector<std::string>& names);
  void call_on_interval() const {
    if (on_interval_) on_interval_();
  }

  std::string folder_;
  Names newest_;                        // names of the recordings, newest first
  std::map<std::string, Names> files_;  // names of the files that may be shown, by name of the recording
  Nanoseconds wall_now_ = 0;            // time at which the list that is being created was requested
  std::function<void()> on_interval_;
  std::size_t folders_read_ = 0;
};

}  // namespace softgrip::web
