#pragma once
// Computes the SHA-256 hash (FIPS 180-4) of configurations, models and logs, for their provenance.

#include <string>
#include <string_view>

namespace softgrip {

/// Returns the digest of `bytes` as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace softgrip
