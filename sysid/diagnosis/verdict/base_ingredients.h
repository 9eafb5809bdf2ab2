#pragma once
// Measures the error reduction of each component of a richer base by its removal, and names the components.

#include <vector>

#include "sysid/diagnosis/search/search.h"
#include "sysid/diagnosis/search/selection.h"
#include "sysid/diagnosis/verdict/base_findings.h"
#include "sysid/structure/structure_choice.h"

namespace softgrip::sysid {

/// Returns the components that must be removed for name_ingredients().
[[nodiscard]] std::vector<Ingredient> named_ingredients();

/// Adds the components of `found.chosen` with a sufficient error reduction as named causes. Components with
/// an uncertain reduction become possible causes. `found.fit` is that base fitted to all readings.
void name_ingredients(BaseFindings& found, const std::vector<WithoutIngredient>& ablation,
                      const BaseSearch& search);

}  // namespace softgrip::sysid
