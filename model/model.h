#pragma once
// A model as a plain value: which blocks stand in the chain and with what numbers. No behaviour, no state.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace softgrip::model {

/// One block of a model. `values` holds its parameters in the order of the block's declaration; of a block
/// with repeated parts, the single ones first, then part by part.
struct BlockSpec {
  std::size_t type = 0;  ///< index in the registry
  std::vector<double> values;

  bool operator==(const BlockSpec&) const = default;
};

/// A chain: command -> valve -> actuator -> load -> sensor -> reading. Valid ones come from load_model(),
/// from the presets or from with_block(); validate() says what is wrong with one made by hand.
struct Model {
  std::string name;
  std::string source;  ///< where its numbers come from, one line
  std::vector<BlockSpec> blocks;

  bool operator==(const Model&) const = default;
};

}  // namespace softgrip::model
