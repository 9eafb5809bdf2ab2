#pragma once
// Converts the text values of Python arguments to C++ enumerations.

#include <initializer_list>
#include <string>
#include <utility>

#include <softgrip/error.h>

namespace softgrip::python {

/// Returns the enumeration value for a text argument that permits only a few words.
template <class Value>
Value chosen(const char* argument, const std::string& word,
             std::initializer_list<std::pair<const char*, Value>> words) {
  std::string all;
  for (const auto& [name, value] : words) {
    if (word == name) return value;
    all += std::string(all.empty() ? "'" : ", '") + name + "'";
  }
  throw InvalidArgument(argument, "'" + word + "' is not one of " + all);
}

}  // namespace softgrip::python
