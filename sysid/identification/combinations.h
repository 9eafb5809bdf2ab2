#pragma once
// Sums and ratios of parameters that the data determine even if they do not determine each parameter (alpha
// and 1/k0 enter only as their sum).

#include <functional>
#include <string>
#include <vector>

#include "model/model.h"

namespace softgrip::sysid {

/// A quantity that is computed from the parameters of a model.
struct Combination {
  std::string name;  ///< including its unit
  std::string unit;
  std::string formula;  ///< formula for display
  double scale = 0;     ///< an interval narrower than this counts as narrow for any value
  std::function<double(const model::Model&)> value;
};

/// Returns the combinations that exist for the blocks of this model.
[[nodiscard]] std::vector<Combination> combinations_of(const model::Model& model);

/// Returns beta divided by the instantaneous gain alpha + 1/k0 of a Bouc-Wen element, or 0 without one. From
/// 1 on the model has an inverse response: it first moves opposite to the command.
[[nodiscard]] double beta_over_gain(const model::Model& model);
/// Returns the warning for a model whose ratio is above 1.
[[nodiscard]] std::string wrong_way_sentence(double beta_over_gain);

}  // namespace softgrip::sysid
