#pragma once
// Measures how much the error increases when a component of a richer base structure is removed, and names the
// components.

#include <vector>

#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/diagnosis/verdict/base_findings.h"
#include "sysid/structure/structure_choice.h"

namespace softgrip::sysid {

/// Returns the components for which name_ingredients() needs a fit without them.
[[nodiscard]] std::vector<Ingredient> named_ingredients();

/// Adds the components of `found.chosen` that reduce the error sufficiently as named causes. Components with
/// an uncertain reduction become possible causes. `found.fit` is the base structure fitted to all readings.
void name_ingredients(BaseFindings& found, const std::vector<WithoutIngredient>& ablation,
                      const BaseSearch& search);

}  // namespace softgrip::sysid
