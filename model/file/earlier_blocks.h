#pragma once
// Describes blocks of earlier versions that contained several effects. In the present version, each effect is
// a separate block. These descriptions determine how a model file with an earlier block is read.

#include <cstddef>
#include <string_view>
#include <vector>

namespace softgrip::model {

/// A block of an earlier version. The new blocks that replace the earlier block have keys with the same names
/// as the keys of the earlier block.
struct EarlierBlock {
  std::string_view id;
  std::vector<std::size_t> types;  ///< types of the blocks that replace the earlier block
  /// Key of the earlier block whose number selects one of the new blocks. Empty: each new block is used that
  /// has an effect with the values in the file.
  std::string_view choice;
  bool adds = false;  ///< true: the new blocks together have the same effect as the earlier block
};

/// Returns the earlier block with this id; nullptr if no earlier block has this id. One of the new blocks can
/// have the id of the earlier block.
[[nodiscard]] const EarlierBlock* find_earlier_block(std::string_view id);

}  // namespace softgrip::model
