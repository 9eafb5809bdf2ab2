#pragma once
// The causes as changes of a constant base, each with few parameters.

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "sysid/changes/base.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid {

/// One parameter of an effect.
struct EffectNumber {
  std::string name;
  std::string unit;
  double scale = 1, lower = 0, upper = 0;
};

/// One form of a cause.
struct Effect {
  std::string id;  ///< id of the cause
  std::string title;
  model::Station station = model::Station::actuator;
  std::string form;  ///< id of the block, or name of a form without a block
  bool free_form = false;
  std::vector<EffectNumber> numbers;
  std::vector<std::vector<double>> starts;
  std::vector<double> nothing;  ///< neutral values; NaN: the value then has no influence
  /// Adds the effect with these parameters.
  std::function<void(Extension&, const std::vector<double>&)> apply;
  /// Id of a cause with equal readings; empty: none.
  std::string twin = {};
  /// Number of parameters that only define the reference of the effect.
  std::size_t nuisance_numbers = 0;
  /// No mechanism matches this effect exactly.
  bool is_ideal = false;
  Appears appears = Appears::anywhere;
  /// Size of this form, if it differs from that of its cause.
  std::optional<SizedBy> size = {};
};

/// Returns all effects that the readings of these later records can show.
/// @param lines  significant lines in the spectrum of their residual.
[[nodiscard]] std::vector<Effect> effects_for(const Base& base, const std::vector<Record>& later,
                                              const std::vector<Line>& lines, bool pressure_is_judged);

}  // namespace softgrip::sysid
