#pragma once
// Defines the parameters of a sequence. A parameter is a number whose value a start request may choose.

#include <string>

#include "document/problem.h"

namespace softgrip::control {

/// A number that a sequence file declares under `parameters` and uses as `$name`.
struct Parameter {
  std::string name;
  std::string unit;  ///< unit, spelled as at the end of keys: "kpa", "mm_per_s"; empty for a number without a
                     ///< unit
  double lower = 0;  ///< smallest allowed value; `upper` is the largest allowed value
  double upper = 0;
  double default_value = 0;
  std::string about;      ///< description of the parameter in one sentence
  document::Location at;  ///< position of the parameter's name in the file
  double value = 0;       ///< value with which the sequence is read; at first the default
};

/// A value that a start request assigns to a parameter, in the unit of the parameter.
struct Argument {
  std::string name;
  double value = 0;
  bool operator==(const Argument&) const = default;
};

}  // namespace softgrip::control
