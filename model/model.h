#pragma once
// Defines a model as a plain value that contains the blocks of the chain and their parameters. model/chain.h
// simulates a model.

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "model/block.h"
#include "model/output_unit.h"

namespace softgrip::model {

/// One block of a model. `values` holds its parameters in the order of their declaration. In a block with
/// repeated parts, the parameters outside the parts come first, then those of each part.
struct BlockSpec {
  std::size_t type = 0;  ///< index in catalogue()
  std::vector<double> values;

  bool operator==(const BlockSpec&) const = default;
};

/// A chain: command -> valve -> actuator -> load -> sensor -> reading. load_model() and with_block() return
/// valid models. validate() returns the problems of a model from another source.
struct Model {
  std::string name;
  std::string source;  ///< source of the parameter values, one line
  std::vector<BlockSpec> blocks;
  OutputUnit output_unit = OutputUnit::mm;  ///< unit of the output; parameters with mm in the name use it too

  bool operator==(const Model&) const = default;
};

/// Returns the problems of a model, one sentence each; empty for a valid model.
[[nodiscard]] std::vector<std::string> validate(const Model& model);

/// Returns a block of a type with its default values, with `parts` repeated parts if the type has any.
[[nodiscard]] BlockSpec default_block(std::size_t type, std::size_t parts = 1);
/// Returns a block of a type with its neutral values, with which it has no effect.
[[nodiscard]] BlockSpec neutral_block(std::size_t type, std::size_t parts = 1);

/// Returns the model with an additional block, at the position that registry.h defines.
[[nodiscard]] Model with_block(Model model, BlockSpec block);
/// Returns the model without the blocks of a type.
[[nodiscard]] Model without_block(Model model, std::size_t type);
/// Returns the model with only those blocks for which `keep(info)` is true.
[[nodiscard]] Model only(Model model, bool (*keep)(const BlockInfo& info));

/// Returns the position of the first block of a type in the model, or an empty value.
[[nodiscard]] std::optional<std::size_t> position_of(const Model& model, std::size_t type);
[[nodiscard]] std::optional<std::size_t> position_of(const Model& model, std::string_view id);

/// Returns the name of value `index` of a block. In a repeated part, the name contains the number of the
/// part: "k2_kpa_per_mm".
[[nodiscard]] std::string parameter_name(const BlockSpec& block, std::size_t index);
/// Returns the index of the value with that name in a block, or nullopt.
[[nodiscard]] std::optional<std::size_t> find_parameter(const BlockSpec& block, std::string_view name);

/// Position of one value in a model.
struct ParameterPlace {
  std::size_t block = 0;  ///< index in Model::blocks
  std::size_t value = 0;  ///< index in BlockSpec::values
};

/// Returns the number of values of all blocks of a model.
[[nodiscard]] std::size_t parameter_count(const Model& model);
/// Returns the position of the value with a flat index, which must be below parameter_count(). A flat index
/// counts the values of all blocks in the order of the chain.
[[nodiscard]] ParameterPlace place_of(const Model& model, std::size_t flat_index);
/// Returns the path of a value, for example "kelvin_voigt.k2_kpa_per_mm". The path contains the number of a
/// repeated block from the second one on: "contact_2.position_mm".
[[nodiscard]] std::string parameter_path(const Model& model, std::size_t flat_index);
/// Returns the flat index of the value with this path, or nullopt.
[[nodiscard]] std::optional<std::size_t> find_path(const Model& model, std::string_view path);
/// Returns the declaration of a value by flat index.
[[nodiscard]] const ParameterSpec& parameter_spec(const Model& model, std::size_t flat_index);

/// Returns all values in chain order, as Chain's `values` expects them.
[[nodiscard]] std::vector<double> flat_values(const Model& model);
/// Returns the model with other values. Their number must equal that of flat_values().
[[nodiscard]] Model with_values(Model model, std::span<const double> values);

}  // namespace softgrip::model
