#include "sysid/structure/structure.h"

#include "model/blocks/bouc_wen.h"
#include "model/blocks/linear_modes.h"
#include "model/blocks/prandtl_ishlinskii.h"

namespace softgrip::sysid {

std::string_view name_of(HysteresisForm form) {
  return form == HysteresisForm::play ? model::PrandtlIshlinskii<double>::info.id
                                      : model::BoucWen<double>::info.id;
}

std::string_view name_of(const BaseStructure& structure) {
  return structure.linear ? model::LinearModes<double>::info.id : name_of(structure.hysteresis);
}

std::string description_of(const BaseStructure& s) {
  if (s.published) {
    return s.lag ? "Bouc-Wen, two Kelvin-Voigt branches, delay and lag"
                 : "Bouc-Wen, two Kelvin-Voigt branches";
  }
  std::string text = s.linear                               ? "linear gain"
                     : !s.hysteretic                        ? "elastic gain"
                     : s.envelopes                          ? "generalised play operators"
                     : s.hysteresis == HysteresisForm::play ? "play operators"
                                                            : "Bouc-Wen";
  if (s.creep) text += s.slow_creep ? ", creep ladder" : ", creep ladder without slow branches";
  if (s.hinged_creep) text += ", pressure-dependent creep";
  if (s.modes > 0) text += ", " + std::to_string(s.modes) + (s.modes > 1 ? " linear modes" : " linear mode");
  if (s.delay) text += ", delay";
  if (s.lag && s.regulator) text += ", regulator with overlap";
  if (s.lag && !s.regulator) text += s.two_way ? ", lag (filling and venting)" : ", lag";
  if (s.lag && s.second_lag && !s.regulator) text += ", second lag";
  if (s.lag && s.rate_limit && !s.regulator) text += ", rate limit";
  if (s.characteristic) text += ", characteristic";
  if (s.resonance) text += ", resonance";
  return text;
}

}  // namespace softgrip::sysid
