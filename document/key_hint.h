#pragma once
// Finds the known key that the user probably meant by an unknown key.

#include <string>
#include <string_view>
#include <vector>

#include "document/node.h"

namespace softgrip::document {

/// The known key that the user probably meant by an unknown key, and a hint for the message. Both texts are
/// empty if no known key is similar.
struct KeyHint {
  std::string key;
  std::string hint;
};

/// Returns the known key that the user probably meant, and a hint for the message.
/// @param key    the unknown key
/// @param value  the value of the unknown key
/// @param known  permitted keys that the map does not contain
[[nodiscard]] KeyHint hint_for_key(std::string_view key, const Node& value,
                                   const std::vector<std::string>& known);

/// Returns the unit at the end of a key: "kpa" for `squeeze_kpa`, "mm_per_s" for `speed_mm_per_s`. Returns an
/// empty text if the key does not end with a unit of the project.
[[nodiscard]] std::string_view unit_at_end(std::string_view key);

/// Returns a hint for a number out of range, such as "the unit is seconds: 130 ms would be 0.13". There is a
/// hint if the number would be in range after a conversion from a related unit to the unit of `key`.
/// Otherwise, the text is empty.
[[nodiscard]] std::string hint_for_range(std::string_view key, double value, double lower, double upper);

}  // namespace softgrip::document
