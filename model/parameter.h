#pragma once
// Defines the declaration of a block's parameter: its key in model files, its limits, its scale for a fit,
// and its text on the reference page.

#include <cstddef>
#include <limits>
#include <string_view>

namespace softgrip::model {

/// One parameter of a block. `name` is the YAML key, the JSON key and the name in reports. If the parameter
/// has a unit, `name` ends with the unit. In a block with repeated parts (Kelvin-Voigt branches), `#` in the
/// name stands for the number of the part. The first part has the number 1.
struct ParameterSpec {
  std::string_view name;
  std::string_view unit;     ///< unit; "" for a number without a unit
  std::string_view meaning;  ///< description of the parameter in one line
  double default_value = 0;  ///< value for which the block has a typical effect
  double lower = 0;          ///< smallest permitted value, inclusive
  double upper = 0;          ///< largest permitted value, inclusive
  double scale = 1;          ///< size of a typical change, by which a fit scales the parameter
  bool whole = false;        ///< true: only integers are permitted (an exponent)
  bool placed = false;       ///< true: a fit keeps the value of this parameter, for example of a threshold.
                             ///< Exception: the parameter is listed in IdentifyOptions::free
  bool latency = false;      ///< true: a dead time, a lag or a period, whose size depends on the kind of rig;
                             ///< `upper` is the limit in files, and a fit uses a smaller upper limit that
                             ///< depends on the logs
  bool per_pressure = false;  ///< true: a gain or a rate per kPa, whose size depends on the range of the
                              ///< pressure; `lower` and `upper` are the limits in files, and a fit uses
                              ///< narrower limits that depend on the logs
  /// Neutral value of the parameter. If every parameter of a block has its neutral value, the block has no
  /// effect. NaN: the parameter has no neutral value, because it has no influence while the other parameters
  /// have their neutral values.
  double neutral = std::numeric_limits<double>::quiet_NaN();
  /// Value that is used if a model file omits the parameter. With this value, a file that is older than the
  /// parameter keeps its meaning. NaN: the file must contain the parameter.
  double if_left_out = std::numeric_limits<double>::quiet_NaN();
  /// Deprecated name of the parameter, which is accepted wherever `name` is accepted; "" if there is none. In
  /// a repeated part, it contains `#` as `name` does.
  std::string_view formerly = {};
};

// Named arguments of parameter(). Each argument sets one member of ParameterSpec.
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
struct Latency {};
struct PerPressure {};
/// Deprecated name of a parameter or a block.
struct Formerly {
  std::string_view name;
};

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
constexpr void add(ParameterSpec& spec, Latency) {
  spec.latency = true;
}
constexpr void add(ParameterSpec& spec, PerPressure) {
  spec.per_pressure = true;
}
constexpr void add(ParameterSpec& spec, Formerly formerly) {
  spec.formerly = formerly.name;
}
}  // namespace declaration

/// Declares one parameter:
///   parameter("rate_mm_per_h", "mm/h", "steady drift", Typical{0.5}, Within{-1e5, 1e5}, Scale{1.0},
///   Neutral{0.0})
/// A typical or neutral value outside the limits of the parameter is a compile error, and so is a deprecated
/// name that equals the name.
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
    throw "the values of a parameter must be within its bounds, and its scale must be above 0";
  }
  if (spec.formerly == name) throw "the deprecated name of a parameter must differ from its name";
  return spec;
}

/// Returns true if `name` equals `declared` after `#` was replaced by the number `part`.
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
