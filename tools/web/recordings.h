#pragma once
// The daemon's recordings, as far as browsers may see them. Names come from browsers and are trusted nowhere.

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

/// Whether it is the name of a recording or of a file in one: letters, digits, ".", "-" and "_", the first of
/// them no dot, 128 at most.
[[nodiscard]] bool is_plain_name(std::string_view name);

/// "image/svg+xml" of a file that is shown; empty of one that is not.
[[nodiscard]] std::string_view content_type_of(std::string_view name);

/// All calls come from one thread.
class Recordings {
 public:
  static constexpr std::size_t most_listed = 200;
  /// A list reads this number of the newest folders at most. It is shorter than `most_listed` if fewer of
  /// them hold a file that is shown. This bounds the memory and the time of a list, however many folders
  /// there are.
  static constexpr std::size_t most_considered = 2000;
  static constexpr std::size_t largest_file = std::size_t{16} << 20U;

  /// `folder` may be empty: then there are none.
  explicit Recordings(std::string folder) : folder_(std::move(folder)) {}

  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }
  /// Returns the newest recordings first: `name`, `files` that can be shown. Reads only the folders that have
  /// changed since the last call.
  /// @param wall_now  wall_time_now(): a folder that has just changed is read again by the next call, because
  ///                  its time stamp cannot tell a second change.
  /// @param between   is called between the folders; may be empty.
  [[nodiscard]] nlohmann::ordered_json list(Nanoseconds wall_now, const std::function<void()>& between = {});
  /// Opens a file; nothing where there is none, or none that is shown. Follows no links.
  [[nodiscard]] std::optional<RegularFile> open(std::string_view recording, std::string_view file) const;
  /// Number of folders that were read from the disk since the start.
  [[nodiscard]] std::size_t folders_read() const noexcept { return folders_read_; }

 private:
  /// Which folder it was and in which state, as stat() says.
  struct Stamp {
    std::uint64_t device = 0;
    std::uint64_t number = 0;
    Nanoseconds changed_at = 0;
    bool operator==(const Stamp&) const = default;
  };
  struct Names {
    Stamp stamp;
    bool settled = false;  // a later change would show another stamp
    std::vector<std::string> names;
  };
  /// Which names of a folder are kept, and in which order.
  struct Choice {
    bool (*is_wanted)(std::string_view name) = nullptr;
    bool last_first = false;
    std::size_t most = 0;
  };

  void bring_up_to_date(Names& known, const Descriptor& parent, const std::string& name,
                        const Choice& choice);
  bool read_names(Descriptor folder, const Choice& choice, std::vector<std::string>& names);
  void pause() const {
    if (between_) between_();
  }

  std::string folder_;
  Names newest_;                        // recordings, newest first
  std::map<std::string, Names> files_;  // that are shown, by the recording
  Nanoseconds wall_now_ = 0;            // of the list that is being made
  std::function<void()> between_;
  std::size_t folders_read_ = 0;
};

}  // namespace softgrip::web
