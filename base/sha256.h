#pragma once
// SHA-256 (FIPS 180-4): hash of a configuration, a model or a log, for provenance.

#include <string>
#include <string_view>

namespace softgrip {

/// Returns the digest of `bytes` as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace softgrip
