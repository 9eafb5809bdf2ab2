#pragma once
// Defines a model as a plain value: the blocks of the chain and their numbers. It has no behaviour and no
// state.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/block.h"
#include "model/output_unit.h"

namespace softgrip::model {

/// One block of a model. `values` holds its parameters in the order of the block's declaration; of a block
/// with repeated parts, the single ones first, then part by part.
struct BlockSpec {
  std::size_t type = 0;  ///< index in catalogue()
  std::vector<double> values;

  bool operator==(const BlockSpec&) const = default;
};

/// A chain: command -> valve -> actuator -> load -> sensor -> reading. Valid ones come from load_model() or
/// from with_block(); validate() says what is wrong with one made by hand.
struct Model {
  std::string name;
  std::string source;  ///< where its numbers come from, one line
  std::vector<BlockSpec> blocks;
  OutputUnit output_unit = OutputUnit::mm;  ///< of its answer, and of every number whose name says mm

  bool operator==(const Model&) const = default;
};

/// Returns the problems of a model, one sentence each; empty for a valid one.
[[nodiscard]] std::vector<std::string> validate(const Model& model);

/// A block of a type with its default values (`parts` of them where parts repeat).
[[nodiscard]] BlockSpec default_block(std::size_t type, std::size_t parts = 1);
/// A block of a type at its neutral values, where it does nothing.
[[nodiscard]] BlockSpec neutral_block(std::size_t type, std::size_t parts = 1);

/// The model with one more block, in the place that registry.h gives it.
[[nodiscard]] Model with_block(Model model, BlockSpec block);
/// The model without the blocks of a type.
[[nodiscard]] Model without_block(Model model, std::size_t type);
/// The model with only those blocks for which `keep(info)` holds.
[[nodiscard]] Model only(Model model, bool (*keep)(const BlockInfo& info));

/// Returns the position of the first block of a type in the model, or an empty value.
[[nodiscard]] std::optional<std::size_t> position_of(const Model& model, std::size_t type);
[[nodiscard]] std::optional<std::size_t> position_of(const Model& model, std::string_view id);

/// "k2_kpa_per_mm": the name of value `index` of a block, numbered where its parts repeat.
[[nodiscard]] std::string parameter_name(const BlockSpec& block, std::size_t index);
/// Index of the value with that name in a block, or nothing.
[[nodiscard]] std::optional<std::size_t> find_parameter(const BlockSpec& block, std::string_view name);

/// One value of a model by its place among all of them.
struct ParameterPlace {
  std::size_t block = 0;  ///< in Model::blocks
  std::size_t value = 0;  ///< in BlockSpec::values
};

/// How many values a model has, all blocks together.
[[nodiscard]] std::size_t parameter_count(const Model& model);
/// Where the flat index points to; it must be below parameter_count().
[[nodiscard]] ParameterPlace place_of(const Model& model, std::size_t flat_index);
/// Returns "kelvin_voigt.k2_kpa_per_mm"; for a repeated block, "contact_2.position_mm".
[[nodiscard]] std::string parameter_path(const Model& model, std::size_t flat_index);
/// The flat index of such a path, or nothing.
[[nodiscard]] std::optional<std::size_t> find_path(const Model& model, std::string_view path);
/// The declaration of a value by flat index.
[[nodiscard]] const ParameterSpec& parameter_spec(const Model& model, std::size_t flat_index);

/// All values in chain order, as Chain's `values` expects them.
[[nodiscard]] std::vector<double> flat_values(const Model& model);
/// The same model with other values; as many as flat_values() gives.
[[nodiscard]] Model with_values(Model model, std::span<const double> values);

}  // namespace softgrip::model
