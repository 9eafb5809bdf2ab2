#pragma once
// Blocks of earlier versions that contained several mechanisms. Each mechanism is a separate block today.
// This table states how a model file with an earlier block is read.

#include <cstddef>
#include <string_view>
#include <vector>

namespace softgrip::model {

/// An earlier block. Its keys have the same names as the keys of its successors.
struct EarlierBlock {
  std::string_view id;
  std::vector<std::size_t> types;  ///< types of the successors
  /// Key whose number selects one successor. If it is empty, each successor with a value that is not neutral
  /// is used.
  std::string_view choice;
  bool adds = false;  ///< several successors together have the same effect as the earlier block
};

/// Returns the earlier block of this id, or nullptr. Some ids are also used by one of the successors.
[[nodiscard]] const EarlierBlock* find_earlier_block(std::string_view id);

}  // namespace softgrip::model
