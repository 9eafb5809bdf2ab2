#pragma once
// Converts arguments and results of Python: NumPy arrays to and from vectors of C++, and words to
// enumerations.
// Adds the parts of the Python module softgrip._core to the module.

#include <pybind11/numpy.h>

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>
#include <softgrip/error.h>

namespace softgrip::python {

using Array = pybind11::array_t<double, pybind11::array::c_style>;

/// Returns a view of the values of an array. The array must exist as long as the view is used.
inline std::span<const double> span_of(const Array& array) {
  return {array.data(), static_cast<std::size_t>(array.size())};
}

/// Returns a copy of the values of an array.
inline std::vector<double> vector_of(const Array& array) {
  return {array.data(), array.data() + array.size()};
}

/// Returns a NumPy array that takes over the values without a copy.
template <class Value>
pybind11::array_t<Value> array_of(std::vector<Value> values) {
  auto owner = std::make_unique<std::vector<Value>>(std::move(values));
  auto* const data = owner.get();
  const pybind11::capsule capsule(owner.release(),
                                  [](void* held) { delete static_cast<std::vector<Value>*>(held); });
  return pybind11::array_t<Value>(static_cast<pybind11::ssize_t>(data->size()), data->data(), capsule);
}

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

/// Adds limits, PID, controller and simulated board. Each function of limits, PID and controller takes only
/// microseconds, so it keeps the global interpreter lock (GIL).
void add_control(pybind11::module_& module);

/// Adds the function `health`, which computes the health of fingers.
void add_health(pybind11::module_& module);

}  // namespace softgrip::python
