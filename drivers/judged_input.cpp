#include "drivers/judged_input.h"

#include <algorithm>
#include <cmath>

namespace softgrip::drivers {
namespace {

using model::Validity;

bool contains(const std::vector<std::uint16_t>& list, std::uint16_t value) noexcept {
  return std::find(list.begin(), list.end(), value) != list.end();
}

Validity status_validity(const StatusBlock& block, std::uint16_t status) noexcept {
  if (contains(block.ok, status)) return Validity::valid;
  if (contains(block.over, status) || contains(block.under, status)) return Validity::out_of_range;
  return Validity::sensor_error;
}

bool is_board_error(const TerminalBlock& inputs, double raw) noexcept {
  return !std::isfinite(raw) ||
         std::find(inputs.error_raws.begin(), inputs.error_raws.end(), raw) != inputs.error_raws.end();
}

bool is_sensor_error(const InputWiring& wiring, double electrical) noexcept {
  return std::any_of(wiring.error_codes.begin(), wiring.error_codes.end(),
                     [electrical](const SensorErrorCode& code) {
                       return std::abs(electrical - code.electrical) <= code.tolerance;
                     });
}

}  // namespace

JudgedInput judge(const BoardMap& map, const InputWiring& wiring, double raw,
                  std::optional<std::uint16_t> status) noexcept {
  if (is_board_error(map.inputs, raw)) return {.validity = Validity::sensor_error};
  JudgedInput input;
  input.electrical = map.inputs.scaling.y_at(raw);
  input.physical = wiring.scaling.y_at(input.electrical);
  input.validity = Validity::valid;
  if (map.input_status.has_value() && status.has_value()) {
    input.validity = status_validity(*map.input_status, *status);
  }
  if (input.validity == Validity::sensor_error) return input;
  if (is_sensor_error(wiring, input.electrical)) {
    input.validity = Validity::sensor_error;
  } else if (input.electrical < wiring.valid_min || input.electrical > wiring.valid_max) {
    input.validity = Validity::out_of_range;
  }
  return input;
}

}  // namespace softgrip::drivers
