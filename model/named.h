#pragma once
// Blocks of a model by their types: an id is written nowhere but in the block's own file, and a block that is
// gone is an error of the compiler.

#include <cstddef>
#include <optional>

#include "model/catalogue.h"
#include "model/model.h"

namespace softgrip::model {

/// Whether a block is of one of these types: is<BoucWen, KelvinVoigt>(block).
template <template <class> class... Block>
[[nodiscard]] constexpr bool is(const BlockInfo& info) {
  return ((info.id == Block<double>::info.id) || ...);
}
template <template <class> class... Block>
[[nodiscard]] bool is(const BlockSpec& block) {
  return is<Block...>(catalogue()[block.type].info);
}

/// BlockSpec::type of a block.
template <template <class> class Block>
[[nodiscard]] std::size_t type_of() {
  return *find_block(Block<double>::info.id);
}

/// Where the first block of a type stands in the model, or nothing.
template <template <class> class Block>
[[nodiscard]] std::optional<std::size_t> position_of(const Model& model) {
  return position_of(model, Block<double>::info.id);
}

}  // namespace softgrip::model
