#include "sysid/structure/ingredient.h"

#include "base/enum_table.h"

namespace softgrip::sysid {

std::string_view name_of(Ingredient ingredient) {
  static constexpr auto names =
      enum_names<Ingredient>({{Ingredient::hysteresis, "hysteresis"},
                              {Ingredient::play_operators, "play operators (replaced by Bouc-Wen)"},
                              {Ingredient::creep, "creep"},
                              {Ingredient::slow_creep, "slow creep"},
                              {Ingredient::pressure_dependent_creep, "dependence of creep on pressure"},
                              {Ingredient::delay, "delay"},
                              {Ingredient::lag, "lag"},
                              {Ingredient::second_lag, "a second lag"},
                              {Ingredient::rate_limit, "a rate limit"},
                              {Ingredient::latency, "delay and lag"},
                              {Ingredient::regulator, "a regulator with overlap (replaced by a lag)"},
                              {Ingredient::venting_lag, "a separate time constant for venting"},
                              {Ingredient::characteristic, "nonlinear characteristic and envelopes"},
                              {Ingredient::resonance, "a resonance"},
                              {Ingredient::linear_modes, "linear modes"},
                              {Ingredient::envelopes, "nonlinear envelopes"}});
  return names[ingredient];
}

BaseStructure without(BaseStructure s, Ingredient ingredient) {
  switch (ingredient) {
    case Ingredient::hysteresis:
      s.hysteretic = s.envelopes = false;
      break;
    case Ingredient::play_operators:
      if (!s.hysteretic) break;
      s.hysteresis = HysteresisForm::bouc_wen;
      s.envelopes = false;
      break;
    case Ingredient::creep:
      s.creep = s.hinged_creep = false;
      break;
    case Ingredient::slow_creep:
      s.slow_creep = false;
      break;
    case Ingredient::pressure_dependent_creep:
      s.hinged_creep = false;
      break;
    case Ingredient::delay:
      s.delay = false;
      break;
    case Ingredient::lag:
      s.lag = s.second_lag = s.rate_limit = false;
      break;
    case Ingredient::second_lag:
      s.second_lag = false;
      break;
    case Ingredient::rate_limit:
      s.rate_limit = false;
      break;
    case Ingredient::latency:
      s.delay = s.lag = s.second_lag = s.rate_limit = false;
      break;
    case Ingredient::regulator:
      s.regulator = false;
      break;
    case Ingredient::venting_lag:
      s.two_way = false;
      break;
    case Ingredient::characteristic:
      s.characteristic = s.envelopes = false;
      break;
    case Ingredient::resonance:
      s.resonance = false;
      break;
    case Ingredient::linear_modes:
      s.modes = 0;
      break;
    case Ingredient::envelopes:
      s.envelopes = false;
      break;
  }
  return s;
}

bool has(const BaseStructure& s, Ingredient ingredient) {
  if (ingredient == Ingredient::latency) return s.delay && s.lag;
  return without(s, ingredient) != s;
}

}  // namespace softgrip::sysid
