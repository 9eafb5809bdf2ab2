#pragma once
// Maps the parameters of a separable chain to their indices in the fit space. Include this header only in
// separable_search and separable_coordinates.

#include <algorithm>
#include <utility>
#include <vector>

#include "sysid/fitting/separable_search.h"

namespace softgrip::sysid {

/// For each parameter of a separable chain, its index in the fit space; -1: the parameter is fixed.
struct SeparableSearch::FreeParts {
  int alpha = -1, k0 = -1, beta = -1, gamma = -1, eta = -1, delay = -1, lag = -1;
  std::vector<int> stiffness, damping;

  FreeParts(const FitSpace& space, const SeparableShape& shape, const model::Model& model)
      : stiffness(shape.branches, -1), damping(shape.branches, -1) {
    for (std::size_t i = 0; i < space.size(); ++i) {
      const FreeParameter& p = space.free()[i];
      if (p.kind != FreeParameter::Kind::model) continue;
      const model::ParameterPlace place = model::place_of(model, p.flat_index);
      const int index = static_cast<int>(i);
      if (shape.delay && place.block == *shape.delay) delay = index;
      if (shape.lag && place.block == *shape.lag) lag = index;
      if (place.block == shape.bouc_wen) {
        for (const auto& [value, slot] :
             {std::pair<std::size_t, int*>{0, &alpha}, {1, &beta}, {2, &gamma}, {3, &eta}}) {
          if (place.value == value) *slot = index;
        }
      }
      if (place.block != shape.kelvin_voigt) continue;
      if (place.value == 0) {
        k0 = index;
      } else {
        ((place.value - 1) % 2 == 0 ? stiffness : damping)[(place.value - 1) / 2] = index;
      }
    }
  }

  [[nodiscard]] bool searchable() const {
    const auto is_free = [](int index) { return index >= 0; };
    return (is_free(alpha) || is_free(k0)) && is_free(beta) && is_free(gamma) == is_free(eta) &&
           std::all_of(stiffness.begin(), stiffness.end(), is_free) &&
           std::all_of(damping.begin(), damping.end(), is_free);
  }
};

}  // namespace softgrip::sysid
