#pragma once
// The daemon's recordings, as far as browsers may see them. Names come from browsers and are trusted nowhere.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace softgrip::web {

/// Whether it is the name of a recording or of a file in one: letters, digits, ".", "-" and "_", the first of
/// them no dot, 128 at most.
[[nodiscard]] bool is_plain_name(std::string_view name);

/// "image/svg+xml" of a file that is shown; empty of one that is not.
[[nodiscard]] std::string_view content_type_of(std::string_view name);

class Recordings {
 public:
  static constexpr std::size_t most_listed = 200;
  static constexpr std::size_t largest_file = std::size_t{16} << 20U;

  /// `folder` may be empty: then there are none.
  explicit Recordings(std::string folder) : folder_(std::move(folder)) {}

  [[nodiscard]] const std::string& folder() const noexcept { return folder_; }
  /// The newest first: `name`, `files` that can be shown.
  [[nodiscard]] nlohmann::ordered_json list() const;
  /// The bytes of a file; nothing where there is none, or none that is shown. Follows no links.
  [[nodiscard]] std::optional<std::string> read(std::string_view recording, std::string_view file) const;

 private:
  std::string folder_;
};

}  // namespace softgrip::web
