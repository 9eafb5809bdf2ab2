#pragma once
// Defines a model: the blocks of a chain and their parameter values. The class Chain (model/chain.h)
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

/// One block of a model. `values` contains its parameters in the order of their declaration. In a block with
/// repeated parts, the parameters that belong to no part precede the parameters of the parts.
struct BlockSpec {
  std::size_t type = 0;  ///< index of the block's type in catalogue()
  std::vector<double> values;

  bool operator==(const BlockSpec&) const = default;
};

/// A chain: command -> valve -> actuator -> load -> sensor -> reading. load_model() and with_block() return
/// valid models. For a model from another source, validate() returns the problems.
struct Model {
  std::string name;
  std::string source;  ///< origin of the parameter values, in one line
  std::vector<BlockSpec> blocks;
  OutputUnit output_unit = OutputUnit::mm;  ///< unit of the output; `mm` in the names of parameters also
                                            ///< means this unit

  bool operator==(const Model&) const = default;
};

/// Returns the problems of a model, one sentence each; empty for a valid model.
[[nodiscard]] std::vector<std::string> validate(const Model& model);

/// Returns a block of a type with the default values of its parameters. If the type has repeated parts, the
/// block has `parts` parts.
[[nodiscard]] BlockSpec default_block(std::size_t type, std::size_t parts = 1);
/// Returns a block of a type with the neutral values of its parameters. With these values, the block has no
/// effect.
[[nodiscard]] BlockSpec neutral_block(std::size_t type, std::size_t parts = 1);

/// Returns the model with one additional block, at the position that follows from the order of the blocks in
/// registry.h.
[[nodiscard]] Model with_block(Model model, BlockSpec block);
/// Returns the model without the blocks of a type.
[[nodiscard]] Model without_block(Model model, std::size_t type);
/// Returns the model that contains only the blocks for which `keep(info)` is true.
[[nodiscard]] Model only(Model model, bool (*keep)(const BlockInfo& info));

/// Returns the index of the first block of a type in the model; nullopt if there is none.
/// The id of the type may be its deprecated id.
[[nodiscard]] std::optional<std::size_t> position_of(const Model& model, std::size_t type);
[[nodiscard]] std::optional<std::size_t> position_of(const Model& model, std::string_view id);

/// Returns the name of the value `index` of a block. In a repeated part, the name contains the number of the
/// part: "k2_kpa_per_mm".
[[nodiscard]] std::string parameter_name(const BlockSpec& block, std::size_t index);
/// Returns the index of the value with this name or deprecated name in a block; nullopt if the block has no
/// such value.
[[nodiscard]] std::optional<std::size_t> find_parameter(const BlockSpec& block, std::string_view name);

/// The position of one value in a model.
struct ParameterPlace {
  std::size_t block = 0;  ///< index of the block in Model::blocks
  std::size_t value = 0;  ///< index of the value in BlockSpec::values
};

/// Returns the total number of values in all blocks of a model.
[[nodiscard]] std::size_t parameter_count(const Model& model);
/// Returns the position of the value with a flat index. The flat index is the position in the list of all
/// values of all blocks, in the order of the chain. It must be below parameter_count().
[[nodiscard]] ParameterPlace place_of(const Model& model, std::size_t flat_index);
/// Returns the path of a value, for example "kelvin_voigt.k2_kpa_per_mm". From the second block of the same
/// type on, the path contains the number of the block: "contact_2.position_mm".
[[nodiscard]] std::string parameter_path(const Model& model, std::size_t flat_index);
/// Returns the path of a value with the deprecated names of its block and its parameter. Returns "" if
/// neither of them has a deprecated name.
[[nodiscard]] std::string former_path(const Model& model, std::size_t flat_index);
/// Returns the flat index of the value with this path; nullopt if the model has no such value. The path may
/// contain deprecated names.
[[nodiscard]] std::optional<std::size_t> find_path(const Model& model, std::string_view path);
/// Returns the declaration of the parameter whose value has this flat index.
[[nodiscard]] const ParameterSpec& parameter_spec(const Model& model, std::size_t flat_index);

/// Returns the values of all blocks in the order of the chain, as the constructor of Chain requires them.
[[nodiscard]] std::vector<double> flat_values(const Model& model);
/// Returns the model with new parameter values, in the order of flat_values(). The number of values must
/// equal parameter_count().
[[nodiscard]] Model with_values(Model model, std::span<const double> values);

}  // namespace softgrip::model
