#pragma once
// Functions that the texts of all studies use.

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>

#include "model/model.h"

namespace softgrip::studies {

/// Aligns `text` to the right in a column of `width` characters. Returns a longer text unchanged.
[[nodiscard]] std::string cell(const std::string& text, std::size_t width);

/// Returns a JSON object with the value of every parameter by its path: {"bouc_wen.alpha_mm_per_kpa": 0.0708,
/// ...}.
[[nodiscard]] nlohmann::ordered_json parameters_of(const model::Model& model);

}  // namespace softgrip::studies
