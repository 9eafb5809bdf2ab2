#pragma once
// Describes all block types as data. Code that lists, reads, writes or fits blocks uses these descriptions
// and not the classes of the blocks. registry.h contains the list of block types.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "model/block.h"

namespace softgrip::model {

/// Description of one block type.
struct BlockDescriptor {
  BlockInfo info;
  std::span<const ParameterSpec> parameters;  ///< parameters that do not belong to a repeated part
  std::span<const ParameterSpec> repeated;    ///< parameters of one repeated part; empty for most blocks
  std::size_t min_parts = 0;  ///< smallest number of repeated parts; 1 if the block declares no other number
  std::size_t max_parts = 0;  ///< largest number of repeated parts
  /// Function that returns the reason why the values of a block are not valid together, or an empty text if
  /// they are valid. nullptr if all combinations of values are valid.
  std::string_view (*objection)(std::span<const double> values) = nullptr;
  /// True: the output at the end of a sample depends only on the input and the surroundings at that time (see
  /// block.h).
  bool at_samples = false;

  /// Returns true if a block of this type may have `value_count` values. The permitted numbers are
  /// parameters.size() + n * repeated.size(), for n from min_parts to max_parts.
  [[nodiscard]] bool accepts(std::size_t value_count) const;
  /// Returns the declaration of the value `index` of a block. Throws std::out_of_range if the block has no
  /// value with this index.
  [[nodiscard]] const ParameterSpec& spec(std::size_t index) const;
  /// Returns the name of the value `index`. In a repeated part, the name contains the number of the part:
  /// "k2_kpa_per_mm". Throws std::out_of_range if the block has no value with this index.
  [[nodiscard]] std::string name(std::size_t index) const;
  /// Returns the deprecated name of the value `index`, with the number of the part as in name(). Returns ""
  /// if the value has no deprecated name.
  [[nodiscard]] std::string former_name(std::size_t index) const;
  /// Returns true if `text` is the name or the deprecated name of the value `index`.
  [[nodiscard]] bool is_named(std::size_t index, std::string_view text) const;

 private:
  [[nodiscard]] std::string numbered(std::string_view declared, std::size_t index) const;
};

/// Returns all block types. The index of a type in the result is BlockSpec::type.
[[nodiscard]] std::span<const BlockDescriptor> catalogue();

/// Returns the index of the block type with this id or deprecated id; nullopt if no type has this id.
[[nodiscard]] std::optional<std::size_t> find_block(std::string_view id);

}  // namespace softgrip::model
