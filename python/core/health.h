#pragma once
// Binds the health of fingers to the Python module softgrip._core.

#include <pybind11/pybind11.h>

namespace softgrip::python {

/// Adds the function `health` to the module.
void add_health(pybind11::module_& module);

}  // namespace softgrip::python
