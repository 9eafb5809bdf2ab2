#pragma once
// Describes all block types as plain data. The code that lists, reads, writes or fits blocks uses these
// descriptions instead of the classes of the blocks. registry.h contains the list of types.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "model/block.h"

namespace softgrip::model {

/// One block type.
struct BlockDescriptor {
  BlockInfo info;
  std::span<const ParameterSpec> parameters;  ///< parameters outside repeated parts
  std::span<const ParameterSpec> repeated;    ///< parameters of one repeated part; empty for most blocks
  std::size_t min_parts = 0;  ///< smallest number of parts; one unless the block states another number
  std::size_t max_parts = 0;  ///< largest number of parts
  /// Returns the reason why these values are not valid together, or an empty text. nullptr: all combinations
  /// are valid.
  std::string_view (*objection)(std::span<const double> values) = nullptr;
  /// The output at the end of a sample depends only on input and surroundings at that time (see block.h).
  bool at_samples = false;

  /// Returns true if a block of this type may have this number of values: parameters.size() + n *
  /// repeated.size(), with n from min_parts to max_parts.
  [[nodiscard]] bool accepts(std::size_t value_count) const;
  /// Returns the declaration of value `index` of a block. Throws std::out_of_range if the index is not valid.
  [[nodiscard]] const ParameterSpec& spec(std::size_t index) const;
  /// Returns the name of value `index`. In a repeated part, the name contains the number of the part:
  /// "k2_kpa_per_mm". Throws like spec().
  [[nodiscard]] std::string name(std::size_t index) const;
};

/// Returns all block types. The index is BlockSpec::type.
[[nodiscard]] std::span<const BlockDescriptor> catalogue();

/// Returns the type with this id, or nullopt.
[[nodiscard]] std::optional<std::size_t> find_block(std::string_view id);

}  // namespace softgrip::model
