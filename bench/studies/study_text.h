#pragma once
// Provides the functions that the texts of all studies use.

#include <cstddef>
#include <string>

#include "base/result/result.h"
#include "model/model.h"

namespace softgrip::studies {

/// Aligns `text` to the right in a column of `width` characters. Returns a longer text unchanged.
[[nodiscard]] std::string cell(const std::string& text, std::size_t width);

/// Returns the value of every parameter; the key is its path, such as "bouc_wen.alpha_mm_per_kpa".
[[nodiscard]] result::Fields parameters_of(const model::Model& model);

}  // namespace softgrip::studies
