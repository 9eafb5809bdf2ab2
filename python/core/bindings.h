#pragma once
// Adds the parts of the Python module softgrip._core to the module.

#include <pybind11/pybind11.h>

namespace softgrip::python {

/// Adds limits, PID, controller and simulated board. Each function of these classes takes only microseconds,
/// so it keeps the global interpreter lock (GIL).
void add_control(pybind11::module_& module);

/// Adds the function `health`, which computes the health of fingers.
void add_health(pybind11::module_& module);

}  // namespace softgrip::python
