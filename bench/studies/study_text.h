#pragma once
// Functions for the texts of all studies.

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>

#include "model/model.h"

namespace softgrip::studies {

/// Right-aligns `text` in a column of `width` characters. A longer text is unchanged.
[[nodiscard]] std::string cell(const std::string& text, std::size_t width);

/// Returns every parameter by its path: {"bouc_wen.alpha_mm_per_kpa": 0.0708, ...}.
[[nodiscard]] nlohmann::ordered_json parameters_of(const model::Model& model);

}  // namespace softgrip::studies
