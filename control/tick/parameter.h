#pragma once
// Defines the parameters of a sequence: numbers whose values a start request may choose.

#include <string>

#include "document/problem.h"

namespace softgrip::control {

/// A number that a sequence file declares under `parameters` and uses as `$name`.
struct Parameter {
  std::string name;
  std::string unit;  ///< unit as at the end of keys: "kpa", "mm_per_s"; empty for a number without a unit
  double lower = 0;  ///< lower and upper are the smallest and the largest allowed value
  double upper = 0;
  double default_value = 0;
  std::string about;      ///< description of the parameter in one sentence
  document::Location at;  ///< place of the parameter's name in the file
  double value = 0;       ///< value of the parameter in this reading of the sequence
};

/// A value that a start request assigns: the name of a parameter, and its value in the unit of the parameter.
struct Argument {
  std::string name;
  double value = 0;
  bool operator==(const Argument&) const = default;
};

}  // namespace softgrip::control
