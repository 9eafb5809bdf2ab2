#pragma once
// Declaration of a parameter of a block: YAML key, limits, bounds and scale of a fit, text of the reference
// page.

#include <cstddef>
#include <limits>
#include <string_view>

namespace softgrip::model {

/// One parameter of a block. `name` ends with the unit, if it has one, and is the YAML key, the JSON key and
/// the name in reports. In a block with repeated parts (Kelvin-Voigt branches), `#` in the name represents
/// the number of the part, counted from 1.
struct ParameterSpec {
  std::string_view name;
  std::string_view unit;     ///< "" for a pure number
  std::string_view meaning;  ///< one line
  double default_value = 0;  ///< a value with a typical effect of the block
  double lower = 0;          ///< smallest permitted value, inclusive
  double upper = 0;          ///< largest permitted value, inclusive
  double scale = 1;          ///< a typical change, for the scaling of a fit
  bool whole = false;        ///< only integers (an exponent)
  bool placed = false;       ///< remains fixed while a fit changes the values that depend on it (a threshold)
  /// If all parameters with a neutral value have that value, the block has no effect. NaN: the parameter has
  /// no neutral value, because it has no influence while the others are neutral.
  double neutral = std::numeric_limits<double>::quiet_NaN();
  /// Value of the parameter if a model file omits it; NaN: the parameter is required. Files that are older
  /// than the parameter therefore keep their meaning.
  double if_left_out = std::numeric_limits<double>::quiet_NaN();
};

// Named arguments of a declaration. Each sets the member of the same meaning above.
struct Typical {
  double value;
};
struct Within {
  double lower, upper;
};
struct Scale {
  double value;
};
struct Neutral {
  double value;
};
struct IfLeftOut {
  double value;
};
struct Whole {};
struct Placed {};

namespace declaration {
constexpr void add(ParameterSpec& spec, Neutral neutral) {
  spec.neutral = neutral.value;
}
constexpr void add(ParameterSpec& spec, IfLeftOut if_left_out) {
  spec.if_left_out = if_left_out.value;
}
constexpr void add(ParameterSpec& spec, Whole) {
  spec.whole = true;
}
constexpr void add(ParameterSpec& spec, Placed) {
  spec.placed = true;
}
}  // namespace declaration

/// Declares one parameter:
///   parameter("rate_mm_per_h", "mm/h", "steady drift", Typical{0.5}, Within{-1e5, 1e5}, Scale{1.0},
///   Neutral{0.0})
/// Values outside the bounds of the parameter are compile errors.
template <class... More>
consteval ParameterSpec parameter(std::string_view name, std::string_view unit, std::string_view meaning,
                                  Typical typical, Within within, Scale scale, More... more) {
  ParameterSpec spec{name, unit, meaning, typical.value, within.lower, within.upper, scale.value};
  (declaration::add(spec, more), ...);
  const auto allowed = [&](double value) {
    return value != value || (value >= within.lower && value <= within.upper);
  };
  if (!allowed(spec.default_value) || !allowed(spec.neutral) || !allowed(spec.if_left_out) ||
      !(spec.scale > 0)) {
    throw "values of a parameter must be within its bounds, and its scale above 0";
  }
  return spec;
}

/// Returns true if `name` is `declared` with the number `part` in place of `#`.
constexpr bool is_name_of_part(std::string_view declared, std::size_t part, std::string_view name) {
  const std::size_t mark = declared.find('#');
  const std::string_view behind = declared.substr(mark + 1);
  if (!name.starts_with(declared.substr(0, mark)) || !name.ends_with(behind)) return false;
  if (name.size() <= mark + behind.size()) return false;
  std::size_t number = 0;
  for (const char c : name.substr(mark, name.size() - mark - behind.size())) {
    if (c < '0' || c > '9') return false;
    number = number * 10 + static_cast<std::size_t>(c - '0');
  }
  return number == part;
}

}  // namespace softgrip::model
