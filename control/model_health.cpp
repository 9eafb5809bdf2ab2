#include "control/model_health.h"

namespace softgrip::control {

const char* name_of(HealthState state) noexcept {
  switch (state) {
    case HealthState::unknown:
      return "unknown";
    case HealthState::healthy:
      return "healthy";
    case HealthState::suspect:
      return "suspect";
    case HealthState::unfit:
      return "unfit";
  }
  return "unknown";
}

}  // namespace softgrip::control
