#pragma once
// The version of this build, for provenance.

#include <string_view>

namespace softgrip {

/// "0.1.0+1a2b3c4": the project's version and what `git describe` called the sources, "-dirty" if they
/// differ.
[[nodiscard]] std::string_view software_version() noexcept;

}  // namespace softgrip
