#pragma once
// What the texts of the studies share.

#include <nlohmann/json.hpp>

#include <cstddef>
#include <string>

#include "model/model.h"

namespace softgrip::tools {

/// `text` at the right of a column of `width` characters; longer text stands as it is.
[[nodiscard]] std::string cell(const std::string& text, std::size_t width);

/// {"bouc_wen.alpha_mm_per_kpa": 0.0708, ...}: every parameter by its path.
[[nodiscard]] nlohmann::ordered_json parameters_of(const model::Model& model);

}  // namespace softgrip::tools
