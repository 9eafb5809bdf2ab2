#pragma once
// The regulator and its tube lag the command.

#include "model/blocks/valve_lag.h"
#include "sysid/diagnosis/causes/form.h"

namespace softgrip::sysid::causes {

struct ValveLag : FormOf<model::ValveLag> {
  static constexpr std::array<std::string_view, 1> confounded_with{"transport_delay"};
  static Starts starts(const Scales&) { return every({{"time_constant_s", {0.02, 0.1, 0.3, 0.6}}}); }
};

}  // namespace softgrip::sysid::causes
