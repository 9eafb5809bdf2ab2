#pragma once
// Blocks of earlier versions that held several mechanisms, which are blocks of their own now: what a model
// file that names one of them means.

#include <cstddef>
#include <string_view>
#include <vector>

namespace softgrip::model {

/// A block as it was. Its keys are those of the blocks that it became, under the same names.
struct EarlierBlock {
  std::string_view id;
  std::vector<std::size_t> types;  ///< what it became
  std::string_view choice;  ///< the key whose number chose one of them; empty: all that its numbers woke
  bool adds = false;        ///< several of them together do what it did with the numbers of both
};

/// The earlier block of this id, or nullptr. Some ids have gone to one of the blocks that it became.
[[nodiscard]] const EarlierBlock* find_earlier_block(std::string_view id);

}  // namespace softgrip::model
