#pragma once
// Describes blocks of earlier versions that contained several effects. Today, each effect is a separate
// block. The table determines how a model file with an earlier block is read.

#include <cstddef>
#include <string_view>
#include <vector>

namespace softgrip::model {

/// An earlier block. Its keys have the same names as the keys of the blocks that replace it.
struct EarlierBlock {
  std::string_view id;
  std::vector<std::size_t> types;  ///< types of the blocks that replace the earlier block
  /// Key whose number selects one of the new blocks. If it is empty, each new block with a value that is not
  /// neutral is used.
  std::string_view choice;
  bool adds = false;  ///< true: several new blocks together have the same effect as the earlier block
};

/// Returns the earlier block with this id, or nullptr. Some of these ids also belong to one of the new
/// blocks.
[[nodiscard]] const EarlierBlock* find_earlier_block(std::string_view id);

}  // namespace softgrip::model
