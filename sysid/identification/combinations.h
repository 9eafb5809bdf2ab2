#pragma once
// Computes sums and ratios of parameters that the data determine even if they do not determine each
// parameter. For example, the data determine only the sum of alpha and 1/k0.

#include <functional>
#include <string>
#include <vector>

#include "model/model.h"

namespace softgrip::sysid {

/// A quantity that is computed from the parameters of a model.
struct Combination {
  std::string name;  ///< name, including the unit
  std::string unit;
  std::string formula;  ///< formula as text, for display
  double scale = 0;     ///< typical value; an interval that is narrow relative to it counts as narrow for any
                        ///< value
  std::function<double(const model::Model&)> value;
};

/// Returns the combinations that exist for the blocks of this model.
[[nodiscard]] std::vector<Combination> combinations_of(const model::Model& model);

/// Returns beta divided by the instantaneous gain alpha + 1/k0 of a Bouc-Wen element, or 0 if the model has
/// none. If the ratio is 1 or more, the model has an inverse response: it first moves opposite to the
/// command.
[[nodiscard]] double beta_over_gain(const model::Model& model);
/// Returns the warning for a model in which this ratio is above 1.
[[nodiscard]] std::string wrong_way_sentence(double beta_over_gain);

}  // namespace softgrip::sysid
