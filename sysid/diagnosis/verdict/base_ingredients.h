#pragma once
// What the ingredients of a richer base bring, by taking each of them away, and the names that they get.

#include <vector>

#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/diagnosis/verdict/base_findings.h"
#include "sysid/structure/structure_choice.h"

namespace softgrip::sysid {

/// What is to be taken away for name_ingredients().
[[nodiscard]] std::vector<Ingredient> named_ingredients();

/// Adds the ingredients of `found.chosen` that bring enough, as named or, where they may bring nothing, as
/// possible. `found.fit` is that base fitted to all readings.
void name_ingredients(BaseFindings& found, const std::vector<WithoutIngredient>& ablation,
                      const BaseSearch& search);

}  // namespace softgrip::sysid
