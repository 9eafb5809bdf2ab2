#pragma once
// What a block says of a parameter, once: the YAML key, its check, the fit's bounds and scale, the manual.

#include <limits>
#include <string_view>

namespace softgrip::model {

/// One parameter of a block. `name` ends with the unit where there is one and is the YAML key, the JSON key
/// and the name in reports. In a block with repeated parts (Kelvin-Voigt branches) `#` in the name stands
/// for the part's number, counted from 1.
struct ParameterSpec {
  std::string_view name;
  std::string_view unit;     ///< "" for a pure number
  double default_value = 0;  ///< a value at which the block does something typical
  double lower = 0;          ///< smallest allowed, itself allowed
  double upper = 0;          ///< largest allowed, itself allowed
  double scale = 1;          ///< a typical change, for the scaling of a fit
  std::string_view meaning;  ///< one line
  bool whole = false;        ///< only whole numbers (an exponent)
  /// The value at which the block does nothing, when all its parameters that have one stand there;
  /// NaN where the value does not matter then.
  double neutral = std::numeric_limits<double>::quiet_NaN();
  /// The value that a model file means when it leaves this one out; NaN: it must be given. For a parameter
  /// that came to a block later, so that older files say what they always said.
  double if_left_out = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace softgrip::model
