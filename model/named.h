#pragma once
// Gives access to blocks of a model by their C++ type, and to the values of blocks by name. The compiler
// checks type and name. A block type that is not registered, and a name that the block does not have, are
// compile errors.
//
//   model::BlockSpec lag = model::block_of<model::ValveLag>({{"time_constant_s", 0.1}});
//   if (const auto* spring = model::find_block<model::KelvinVoigt>(model))
//     k0 = model::value<model::KelvinVoigt>(*spring, "k0_kpa_per_mm");

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string_view>
#include <utility>

#include "model/model.h"
#include "model/registry.h"

namespace softgrip::model {

/// Returns the index of a value in BlockSpec::values. The name of a value in a repeated part contains the
/// number of the part: "k2_kpa_per_mm".
template <template <class> class Block>
consteval std::size_t parameter_index(std::string_view name) {
  using B = Block<double>;
  std::size_t index = 0;
  for (const ParameterSpec& spec : B::parameters) {
    if (spec.name == name) return index;
    ++index;
  }
  if constexpr (requires { B::repeated; }) {
    for (std::size_t part = 1; part <= B::max_parts; ++part) {
      for (const ParameterSpec& spec : B::repeated) {
        if (is_name_of_part(spec.name, part, name)) return index;
        ++index;
      }
    }
  }
  throw "the block has no parameter of this name";
}

/// The name of a value of a block, stored as the index of this value.
template <template <class> class Block>
struct ParameterName {
  std::size_t index;
  consteval ParameterName(const char* name)  // NOLINT(google-explicit-constructor): written as text
      : index(parameter_index<Block>(name)) {}
};

/// A value of a block, together with the name of this value.
template <template <class> class Block>
struct NamedValue {
  ParameterName<Block> name;
  double value;
};

/// Returns a block with the values in `values`. The parameters that `values` does not contain get their
/// neutral values.
template <template <class> class Block>
[[nodiscard]] BlockSpec block_of(std::initializer_list<NamedValue<Block>> values, std::size_t parts = 1) {
  BlockSpec block = neutral_block(block_type<Block>(), parts);
  for (const NamedValue<Block>& named : values) block.values.at(named.name.index) = named.value;
  return block;
}

/// Returns true if a block has one of the types in the template arguments, as in is<BoucWen,
/// KelvinVoigt>(block).
template <template <class> class... Block>
[[nodiscard]] constexpr bool is(const BlockSpec& block) {
  return ((block.type == block_type<Block>()) || ...);
}
template <template <class> class... Block>
[[nodiscard]] constexpr bool is(const BlockInfo& info) {
  return ((info.id == Block<double>::info.id) || ...);
}

/// Returns the value with this name of a block. Throws std::out_of_range if the name belongs to a repeated
/// part that the block does not have.
template <template <class> class Block>
[[nodiscard]] double value(const BlockSpec& block, ParameterName<Block> name) {
  return block.values.at(name.index);
}
template <template <class> class Block>
[[nodiscard]] double& value(BlockSpec& block, ParameterName<Block> name) {
  return block.values.at(name.index);
}

/// Returns the index of the first block of this type in the model; nullopt if the model has no block of this
/// type.
template <template <class> class Block>
[[nodiscard]] std::optional<std::size_t> position_of(const Model& model) {
  return position_of(model, block_type<Block>());
}

/// Returns the first block of this type; nullptr if the model has no block of this type.
template <template <class> class Block>
[[nodiscard]] const BlockSpec* find_block(const Model& model) {
  const auto position = position_of<Block>(model);
  return position ? &model.blocks[*position] : nullptr;
}
template <template <class> class Block>
[[nodiscard]] BlockSpec* find_block(Model& model) {
  const auto position = position_of<Block>(model);
  return position ? &model.blocks[*position] : nullptr;
}

/// Returns a value of the first block of this type; nullopt if the model has no block of this type.
template <template <class> class Block>
[[nodiscard]] std::optional<double> value_in(const Model& model, ParameterName<Block> name) {
  const BlockSpec* const block = find_block<Block>(model);
  return block != nullptr ? std::optional(value<Block>(*block, name)) : std::nullopt;
}

/// Returns true if the model has a block of at least one of these types.
template <template <class> class... Block>
[[nodiscard]] bool has_any(const Model& model) {
  return (position_of<Block>(model).has_value() || ...);
}

template <template <class> class Block>
[[nodiscard]] Model without_block(Model model) {
  return without_block(std::move(model), block_type<Block>());
}

/// Returns the model that contains only the blocks of these types.
template <template <class> class... Block>
[[nodiscard]] Model only(Model model) {
  std::erase_if(model.blocks, [](const BlockSpec& block) { return !is<Block...>(block); });
  return model;
}

}  // namespace softgrip::model
