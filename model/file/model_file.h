#pragma once
// Converts model files (YAML) to Model and back, without loss of information.
//
//   name: bench_twin
//   source: where the numbers come from, one line
//   valve:
//     - transport_delay: {delay_s: 0.130}
//     - valve_lag: {time_constant_s: 0.044}
//   actuator:
//     - bouc_wen: {alpha_mm_per_kpa: 0.21105, ..., exponent: 1}
//     - kelvin_voigt: {k0_kpa_per_mm: 325.9, k1_kpa_per_mm: 18.16, c1_kpa_s_per_mm: 299.8, ...}
//
// A station without blocks may be omitted, or it may be an empty list. The names of blocks and parameters may
// be deprecated names (see block.h); a written file contains the present names. With `output_unit: deg`, the
// output of the model is a bending angle, and `mm` in the names of parameters means deg.

#include <optional>
#include <string>

#include "document/node.h"
#include "model/model.h"

namespace softgrip::model {

/// Reads a model from a parsed document. Adds all errors to `problems`. Returns nullopt if the model has
/// errors.
[[nodiscard]] std::optional<Model> read_model(const document::Document& document,
                                              document::Problems& problems);

/// Reads a model for a rig, as read_model() does. A rig measures in mm, so a model with another output unit
/// than mm is an error.
[[nodiscard]] std::optional<Model> read_rig_model(const document::Document& document,
                                                  document::Problems& problems);

/// Reads a file with parse_file() and read_model().
[[nodiscard]] std::optional<Model> load_model(const std::string& path, document::Problems& problems);
/// Reads a file with parse_file() and read_rig_model().
[[nodiscard]] std::optional<Model> load_rig_model(const std::string& path, document::Problems& problems);

/// Returns the YAML text of a model. Each number has the smallest number of digits that determines the double
/// exactly. Therefore, read_model(parse(to_yaml(m))) == m for every valid model m.
[[nodiscard]] std::string to_yaml(const Model& model);

/// Returns 16 hexadecimal digits that identify the blocks and numbers of a model in provenance records. The
/// digits are the FNV-1a hash (64 bit) of the text that to_yaml() returns. The hash does not depend on the
/// machine, and changes if any digit of a number changes. In the hashed text, deprecated names replace the
/// present names, so that a hash in an older record remains valid.
[[nodiscard]] std::string model_hash(const Model& model);

}  // namespace softgrip::model
