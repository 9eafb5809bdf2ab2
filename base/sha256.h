#pragma once
// SHA-256 (FIPS 180-4), for provenance: the hash of a configuration, a model or a log.

#include <string>
#include <string_view>

namespace softgrip {

/// The digest of `bytes`: 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view bytes);

}  // namespace softgrip
