#pragma once
// Lists the descriptions of all blocks as plain data by index. Code that lists, reads, writes or fits blocks
// uses it without stepping them. It is filled from the list in registry.h.

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
  std::span<const ParameterSpec> parameters;  ///< the single ones
  std::span<const ParameterSpec> repeated;    ///< of one part; empty for most blocks
  std::size_t min_parts = 0;                  ///< least parts; one, where a block does not say otherwise
  std::size_t max_parts = 0;                  ///< most parts
  /// Why these values do not fit each other, or empty. nullptr when any do.
  std::string_view (*objection)(std::span<const double> values) = nullptr;
  /// Its output at the end of a sample follows from its input and its surroundings there (block.h).
  bool at_samples = false;

  /// How many values a block of this type may have: parameters.size() + n repeated.size().
  [[nodiscard]] bool accepts(std::size_t value_count) const;
  /// The declaration of value `index` of a block. Throws std::out_of_range where no block has one.
  [[nodiscard]] const ParameterSpec& spec(std::size_t index) const;
  /// Its name, numbered where parts repeat: "k2_kpa_per_mm". Throws like spec().
  [[nodiscard]] std::string name(std::size_t index) const;
};

/// All block types, by BlockSpec::type.
[[nodiscard]] std::span<const BlockDescriptor> catalogue();

/// The type with this id, or nothing.
[[nodiscard]] std::optional<std::size_t> find_block(std::string_view id);

}  // namespace softgrip::model
