#pragma once
// The C99 source text of the parts of an exported model. The C code computes the same as the classes in
// model/, but for one fixed sampling interval and without templates.

#include <string_view>

namespace softgrip::tools::c_text {

/// Segments and linear responses (model/segment.h, model/exponential.h). All other fragments use them.
extern const std::string_view common;
/// model/blocks/transport_delay.h; needs DELAY_PIECES, a power of two.
extern const std::string_view transport_delay;
/// model/blocks/valve_lag.h
extern const std::string_view valve_lag;
/// model/two_way_lag.h
extern const std::string_view two_way_lag;
/// model/blocks/rate_limit.h
extern const std::string_view rate_limit;
/// model/blocks/bouc_wen.h, exponent 1
extern const std::string_view bouc_wen;
/// model/play.h and model/blocks/prandtl_ishlinskii.h
extern const std::string_view prandtl_ishlinskii;
/// model/blocks/kelvin_voigt.h
extern const std::string_view kelvin_voigt;
/// model/blocks/pressure_dependent_creep.h
extern const std::string_view pressure_dependent_creep;
/// model/characteristic_map.h and model/blocks/characteristic.h
extern const std::string_view characteristic;
/// Computes the pressure at which the blocks behind the valve reach a given displacement one tick from now.
extern const std::string_view inverse;

}  // namespace softgrip::tools::c_text
