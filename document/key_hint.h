#pragma once
// Suggests the key that was probably meant instead of an unknown one.

#include <string>
#include <string_view>
#include <vector>

#include "document/node.h"

namespace softgrip::document {

/// The known key that an unknown one probably stands for, or an empty key.
struct KeyHint {
  std::string key;
  std::string hint;
};

/// @param key    the unknown key
/// @param value  its value
/// @param known  permitted keys that the map does not contain yet
[[nodiscard]] KeyHint hint_for_key(std::string_view key, const Node& value,
                                   const std::vector<std::string>& known);

/// The unit at the end of a key, in the project's own units: "kpa" of `squeeze_kpa`, "mm_per_s" of
/// `speed_mm_per_s`; empty for a key that has none.
[[nodiscard]] std::string_view unit_at_end(std::string_view key);

/// "did you mean 0.13?" for a number out of range that a smaller or larger unit would explain, by the unit at
/// the end of its key; or empty.
[[nodiscard]] std::string hint_for_range(std::string_view key, double value, double lower, double upper);

}  // namespace softgrip::document
