#pragma once
// Defines causes as changes of the unchanged baseline model. Each change has few parameters.

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
  std::string formerly = {};  ///< deprecated name of the parameter; empty: none
  std::string meaning = {};   ///< description of the parameter; empty: the name is used
};

/// One form of a cause, stated as an effect on the baseline model.
struct Effect {
  std::string id;  ///< id of the cause
  std::string title;
  model::Station station = model::Station::actuator;
  std::string form;  ///< id of the block, or name of a form without a block
  bool free_form = false;
  std::vector<EffectNumber> numbers;
  std::vector<std::vector<double>> starts;
  /// Parameter values for which the effect vanishes. NaN: the other parameters remove the effect, so this
  /// parameter has no neutral value.
  std::vector<double> nothing;
  /// Adds the effect to an extension. The second argument contains the parameter values.
  std::function<void(Extension&, const std::vector<double>&)> apply;
  /// Id of a cause that leads to the same readings for every command; empty: there is no such cause.
  std::string indistinguishable = {};
  /// Number of parameters that only define the reference of the effect, such as a gain that is fitted
  /// together with a curvature.
  std::size_t nuisance_numbers = 0;
  /// True if the effect is a mathematical idealisation that no physical mechanism matches exactly.
  bool is_ideal = false;
  Appears appears = Appears::anywhere;
  /// Quantity that states the size of this form. Not set: the quantity of the cause is used.
  std::optional<SizedBy> size = {};
};

/// An effect and the fitted values of its parameters.
struct FittedEffect {
  Effect effect;
  std::vector<double> numbers;
};

[[nodiscard]] Extension extension_of(const std::vector<FittedEffect>& effects);

/// Returns all effects that can be tested with the later records.
/// @param lines  significant lines in the spectrum of the residual of the later records.
[[nodiscard]] std::vector<Effect> effects_for(const Base& base, const std::vector<Record>& later,
                                              const std::vector<Line>& lines, bool pressure_is_judged);

}  // namespace softgrip::sysid
