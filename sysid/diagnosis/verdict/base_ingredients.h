#pragma once
// Removes each component of a richer base structure, measures how much the error increases, and names the
// components whose removal increases the error.

#include <vector>

#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/diagnosis/verdict/base_findings.h"
#include "sysid/structure/structure_choice.h"

namespace softgrip::sysid {

/// Returns the components that name_ingredients() can name. For each of them, name_ingredients() needs a fit
/// without this component.
[[nodiscard]] std::vector<Ingredient> named_ingredients();

/// Tests the components of `found.chosen`. A component that reduces the error sufficiently becomes a named
/// cause. A component whose error reduction is uncertain becomes a possible cause. `found.fit` must be the
/// base structure fitted to all readings.
void name_ingredients(BaseFindings& found, const std::vector<WithoutIngredient>& ablation,
                      const BaseSearch& search);

}  // namespace softgrip::sysid
