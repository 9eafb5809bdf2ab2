#pragma once
// Exports a model as a self-contained C99 file, for C blocks of Simulink, a PLC or a microcontroller.
// Declares the C99 source text of the parts of an exported model. The C code computes the same values as the
// classes in model/, but for one fixed sampling interval and without templates. The command changes linearly
// during a sampling interval. Therefore no segment is a jump, and the C code omits the rules for jumps.

#include <string>
#include <string_view>

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

namespace softgrip::tools::c_text {

/// Segments and linear responses, as in model/segment.h and model/exponential.h. All other fragments use this
/// code.
extern const std::string_view common;
/// Dead time, as in model/blocks/transport_delay.h. Needs the macro DELAY_PIECES, a power of two.
extern const std::string_view transport_delay;
/// First-order lag of the valve, as in model/blocks/valve_lag.h.
extern const std::string_view valve_lag;
/// Lag with one time constant per direction, as in model/two_way_lag.h.
extern const std::string_view two_way_lag;
/// Rate limit, as in model/blocks/rate_limit.h.
extern const std::string_view rate_limit;
/// Bouc-Wen hysteresis of exponent 1, as in model/blocks/bouc_wen.h.
extern const std::string_view bouc_wen;
/// Sum of play operators, as in model/play.h and model/blocks/prandtl_ishlinskii.h.
extern const std::string_view prandtl_ishlinskii;
/// Viscoelastic creep, as in model/blocks/kelvin_voigt.h.
extern const std::string_view kelvin_voigt;
/// Creep above a pressure, as in model/blocks/pressure_dependent_creep.h.
extern const std::string_view pressure_dependent_creep;
/// Second-order modes with gains of either sign, as in model/second_order.h and model/blocks/linear_modes.h.
extern const std::string_view linear_modes;
/// Characteristic map, as in model/characteristic_map.h and model/blocks/characteristic.h.
extern const std::string_view characteristic;
/// C function that computes the pressure at which the blocks behind the valve reach a given displacement one
/// sampling interval later.
extern const std::string_view inverse;

}  // namespace softgrip::tools::c_text
