#pragma once
// Computes combinations of parameters, which are sums and ratios. The data can determine a combination even
// if they do not determine each of its parameters. For example, the data determine only the sum of alpha and
// 1/k0.

#include <functional>
#include <string>
#include <vector>

#include "model/model.h"

namespace softgrip::sysid {

/// A quantity that is computed from the parameters of a model.
struct Combination {
  std::string name;  ///< name of the combination, including the unit
  std::string unit;
  std::string formula;  ///< formula of the combination as text, for display
  double scale = 0;     ///< typical value of the combination, with which the width of its interval is
                        ///< compared
  std::function<double(const model::Model&)> value;
  model::Formerly formerly = {};  ///< deprecated name of the combination; empty: none
};

/// Returns all combinations that are defined for the blocks of this model.
[[nodiscard]] std::vector<Combination> combinations_of(const model::Model& model);

/// Returns beta / (alpha + 1/k0) of the Bouc-Wen element of a model, or 0 if the model has no such element.
/// The denominator is the instantaneous gain. If the ratio is above 1, the model has an inverse response: its
/// displacement first moves opposite to a change of the command.
[[nodiscard]] double beta_over_gain(const model::Model& model);
/// Returns the warning for a model whose ratio beta_over_gain() is above 1.
[[nodiscard]] std::string wrong_way_sentence(double beta_over_gain);

}  // namespace softgrip::sysid
