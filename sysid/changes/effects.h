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

/// One number of an effect.
struct EffectNumber {
  std::string name;
  std::string unit;
  double scale = 1, lower = 0, upper = 0;
};

/// A cause in one form.
struct Effect {
  std::string id;  ///< of the vocabulary of causes
  std::string title;
  model::Station station = model::Station::actuator;
  std::string form;  ///< of the block, or of what has no block
  bool free_form = false;
  std::vector<EffectNumber> numbers;
  std::vector<std::vector<double>> starts;
  std::vector<double> nothing;  ///< where it does nothing; NaN: does not matter there
  /// Adds the effect with these numbers.
  std::function<void(Extension&, const std::vector<double>&)> apply;
  /// The id of a cause that gives the same readings; or none.
  std::string twin = {};
  /// Of its numbers, how many only say where it is counted from.
  std::size_t nuisance_numbers = 0;
  /// No mechanism is quite like it.
  bool is_ideal = false;
  Appears appears = Appears::anywhere;
  /// Size of this form, if it differs from that of its cause.
  std::optional<SizedBy> size = {};
};

/// All effects that the reading of these later records can show.
/// @param lines  what stands out of their residual's spectrum.
[[nodiscard]] std::vector<Effect> effects_for(const Base& base, const std::vector<Record>& later,
                                              const std::vector<Line>& lines, bool pressure_is_judged);

}  // namespace softgrip::sysid
