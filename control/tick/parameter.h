#pragma once
// The parameters of a sequence: numbers that a start may choose.

#include <string>

#include "document/problem.h"

namespace softgrip::control {

/// A number that a sequence file declares under `parameters` and uses as `$name`.
struct Parameter {
  std::string name;
  std::string unit;  ///< as at the end of keys: "kpa", "mm_per_s"; empty for a plain number
  double lower = 0;  ///< lower and upper are allowed values
  double upper = 0;
  double default_value = 0;
  std::string about;      ///< one sentence
  document::Location at;  ///< place of its name in the file
  double value = 0;       ///< value with which the sequence was read
};

/// An argument of a start request: the name of a parameter and its value, in the parameter's unit.
struct Argument {
  std::string name;
  double value = 0;
  bool operator==(const Argument&) const = default;
};

}  // namespace softgrip::control
