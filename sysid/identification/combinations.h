#pragma once
// What a finger shows of its parameters: sums and ratios that data can tell where the parameters alone are
// not told apart (alpha and 1/k0 enter only as their sum).

#include <functional>
#include <string>
#include <vector>

#include "model/model.h"

namespace softgrip::sysid {

/// A number that follows from a model.
struct Combination {
  std::string name;  ///< with its unit
  std::string unit;
  std::string formula;  ///< for people
  double scale = 0;     ///< what counts as small: an interval below it is narrow whatever the value
  std::function<double(const model::Model&)> value;
};

/// Those that make sense for the blocks of this model.
[[nodiscard]] std::vector<Combination> combinations_of(const model::Model& model);

/// beta over the instantaneous gain alpha + 1/k0 of a Bouc-Wen element; 0 without one. From 1 on the model
/// moves the wrong way first.
[[nodiscard]] double beta_over_gain(const model::Model& model);
/// What is said of a model whose ratio is above 1.
[[nodiscard]] std::string wrong_way_sentence(double beta_over_gain);

}  // namespace softgrip::sysid
