#pragma once
// Words of arguments, as the package has them.

#include <initializer_list>
#include <string>
#include <utility>

#include <softgrip/error.h>

namespace softgrip::python {

/// One of a few words of an argument.
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
