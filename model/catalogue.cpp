#include "model/catalogue.h"

#include <array>
#include <stdexcept>

#include "model/registry.h"

namespace softgrip::model {
namespace {

template <class Block>
BlockDescriptor describe() {
  BlockDescriptor result{Block::info, Block::parameters, {}, 0, 0, nullptr};
  if constexpr (requires { Block::repeated; }) {
    result.repeated = Block::repeated;
    result.min_parts = 1;
    if constexpr (requires { Block::min_parts; }) result.min_parts = Block::min_parts;
    result.max_parts = Block::max_parts;
  }
  if constexpr (requires { Block::objection(std::span<const double>{}); })
    result.objection = &Block::objection;
  if constexpr (requires { Block::at_samples; }) {
    result.at_samples = Block::at_samples;
  } else {
    result.at_samples = Block::info.kind == Kind::reading;
  }
  return result;
}

template <template <class> class... Block>
std::array<BlockDescriptor, sizeof...(Block)> describe_all(BlockList<Block...>) {
  return {describe<Block<double>>()...};
}

}  // namespace

bool BlockDescriptor::accepts(std::size_t value_count) const {
  if (repeated.empty()) return value_count == parameters.size();
  if (value_count < parameters.size()) return false;
  const std::size_t rest = value_count - parameters.size();
  const std::size_t parts = rest / repeated.size();
  return rest % repeated.size() == 0 && parts >= min_parts && parts <= max_parts;
}

const ParameterSpec& BlockDescriptor::spec(std::size_t index) const {
  if (index < parameters.size()) return parameters[index];
  const std::size_t behind = index - parameters.size();
  if (behind >= max_parts * repeated.size()) {
    throw std::out_of_range(std::string(info.id) + " has no value " + std::to_string(index));
  }
  return repeated[behind % repeated.size()];
}

std::string BlockDescriptor::name(std::size_t index) const {
  return numbered(spec(index).name, index);
}

std::string BlockDescriptor::former_name(std::size_t index) const {
  return numbered(spec(index).formerly, index);
}

bool BlockDescriptor::is_named(std::size_t index, std::string_view text) const {
  return name(index) == text || (!spec(index).formerly.empty() && former_name(index) == text);
}

/// Returns the declared name of the value `index`, with the number of its part in place of `#`.
std::string BlockDescriptor::numbered(std::string_view declared, std::size_t index) const {
  std::string name(declared);
  if (index >= parameters.size() && !name.empty()) {
    const std::size_t part = (index - parameters.size()) / repeated.size();
    name.replace(name.find('#'), 1, std::to_string(part + 1));
  }
  return name;
}

std::span<const BlockDescriptor> catalogue() {
  static const auto all = describe_all(Blocks{});
  return all;
}

std::optional<std::size_t> find_block(std::string_view id) {
  const std::span<const BlockDescriptor> all = catalogue();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].info.is_named(id)) return i;
  }
  return std::nullopt;
}

}  // namespace softgrip::model
