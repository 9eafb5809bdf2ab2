#pragma once
// Defines causes as changes of a constant baseline model. Each of them has few parameters.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/changes/base.h"
#include "sysid/changes/extension.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid {

/// One parameter of an effect.
struct EffectNumber {
  std::string name;
  std::string unit;
  double scale = 1, lower = 0, upper = 0;
};

/// An effect on the baseline model: one form of a cause.
struct Effect {
  std::string id;  ///< id of the cause
  std::string title;
  model::Station station = model::Station::actuator;
  std::string form;  ///< id of the block, or name of a form without a block
  bool free_form = false;
  std::vector<EffectNumber> numbers;
  std::vector<std::vector<double>> starts;
  /// Neutral value of each parameter; NaN: if the effect is neutral, the parameter has no influence.
  std::vector<double> nothing;
  /// Adds the effect with these parameter values to an extension.
  std::function<void(Extension&, const std::vector<double>&)> apply;
  /// Id of a cause with equal readings for every command; empty: none.
  std::string indistinguishable = {};
  /// Number of parameters that only define the reference of the effect.
  std::size_t nuisance_numbers = 0;
  /// True if no mechanism matches this effect exactly.
  bool is_ideal = false;
  Appears appears = Appears::anywhere;
  /// Quantity that states the size of this form; not set: the quantity of its cause is used.
  std::optional<SizedBy> size = {};
};

/// An effect with the values of its parameters.
struct FittedEffect {
  Effect effect;
  std::vector<double> numbers;
};

[[nodiscard]] Extension extension_of(const std::vector<FittedEffect>& effects);

/// Returns all effects that the later records can show.
/// @param lines  significant lines in the spectrum of the residual of these records.
[[nodiscard]] std::vector<Effect> effects_for(const Base& base, const std::vector<Record>& later,
                                              const std::vector<Line>& lines, bool pressure_is_judged);

}  // namespace softgrip::sysid
