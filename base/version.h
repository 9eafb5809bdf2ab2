#pragma once
// Returns the version of this build, for provenance.

#include <string_view>

namespace softgrip {

/// Returns the version of this build, for example "0.2.0+1a2b3c4". The text consists of the project's version
/// and the result of `git describe`. The text ends with "-dirty" if the sources have changes that are not
/// committed.
[[nodiscard]] std::string_view software_version() noexcept;

}  // namespace softgrip
