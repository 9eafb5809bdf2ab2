#pragma once
/// @file
/// Declares the version of the library. The changelog announces every incompatible change of this interface.

#include <string>

#include <softgrip/export.h>

namespace softgrip {

/// Returns the version of the loaded library with its commit, for example "0.2.0+1a2b3c4". The part before
/// `+` follows semantic versioning. Before version 1.0.0, a new minor version may change the interface.
[[nodiscard]] SOFTGRIP_API std::string version();

}  // namespace softgrip
