#pragma once
// Binds limits, PID, controller and simulated board to the Python module softgrip._core.

#include <pybind11/pybind11.h>

namespace softgrip::python {

/// Adds the classes to the module. Each function of these classes takes only microseconds, so it keeps the
/// global interpreter lock (GIL).
void add_control(pybind11::module_& module);

}  // namespace softgrip::python
