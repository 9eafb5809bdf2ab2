#pragma once
// softgrip._core: limits, PID, controller and simulated board.

#include <pybind11/pybind11.h>

namespace softgrip::python {

/// Adds the classes to the module. Their functions take microseconds and keep the GIL.
void add_control(pybind11::module_& module);

}  // namespace softgrip::python
