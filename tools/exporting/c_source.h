#pragma once
// Exports a model as a self-contained C99 file, for C blocks of Simulink, a PLC or a microcontroller.

#include <string>

#include <tl/expected.hpp>

#include "model/model.h"

namespace softgrip::tools {

struct CSource {
  std::string text;
  std::string name;        ///< prefix of the C functions NAME_reset(), NAME_step() and NAME_inverse_step()
  std::string no_inverse;  ///< reason why the model has no inverse; empty: the model has an inverse
};

/// Returns the C file for a fixed sampling interval of `tick_s`. The code allocates no memory, has no globals
/// and needs only <math.h>. NAME_step() computes the same displacement as Chain::step (within 1e-9 mm).
/// NAME_inverse_step() computes the same pressure as the full_model feedforward: the pressure that produces a
/// displacement one sampling interval later. This pressure compensates the lags of the valve, but not the
/// delay of the valve. The caller must therefore pass the reference earlier by this delay. The error names
/// the blocks that have no C version.
/// @param pressure_max_kpa  highest pressure at which the inverse must exist
[[nodiscard]] tl::expected<CSource, std::string> c_source(const model::Model& model, double tick_s,
                                                          double pressure_max_kpa,
                                                          const std::string& software);

}  // namespace softgrip::tools
