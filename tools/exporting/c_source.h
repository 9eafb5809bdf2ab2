#pragma once
// A model as a self-contained C99 file, for Simulink's C blocks, a PLC's or a microcontroller.

#include <string>

#include <tl/expected.hpp>

#include "model/model.h"

namespace softgrip::tools {

struct CSource {
  std::string text;
  std::string name;        ///< of its functions: NAME_reset(), NAME_step(), NAME_inverse_step()
  std::string no_inverse;  ///< why there is none; empty: there is
};

/// The file for one tick of `tick_s`: no allocation, no globals, <math.h> alone. Its step is what Chain::step
/// computes (1e-9 mm), its inverse what full_model feedforward does: the pressure for a displacement one tick
/// from now, with the valve's lags led and its delay left to whoever knows the reference that far ahead. The
/// error names the blocks that have no C yet.
/// @param pressure_max_kpa  up to which the inverse must exist
[[nodiscard]] tl::expected<CSource, std::string> c_source(const model::Model& model, double tick_s,
                                                          double pressure_max_kpa,
                                                          const std::string& software);

}  // namespace softgrip::tools
