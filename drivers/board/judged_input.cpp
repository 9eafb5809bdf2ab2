#include "drivers/board/judged_input.h"

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

JudgedInput judge(const InputWiring& wiring, double electrical) noexcept {
  JudgedInput input{electrical, wiring.scaling.y_at(electrical), Validity::valid};
  if (is_sensor_error(wiring, electrical)) {
    input.validity = Validity::sensor_error;
  } else if (electrical < wiring.valid_min || electrical > wiring.valid_max) {
    input.validity = Validity::out_of_range;
  }
  return input;
}

JudgedInput judge(const BoardMap& map, const InputWiring& wiring, double raw,
                  std::optional<std::uint16_t> status) noexcept {
  if (is_board_error(map.inputs, raw)) return {.validity = Validity::sensor_error};
  JudgedInput input = judge(wiring, map.inputs.scaling.y_at(raw));
  if (input.validity == Validity::sensor_error || !map.input_status.has_value() || !status.has_value()) {
    return input;
  }
  const Validity said = status_validity(*map.input_status, *status);
  if (said != Validity::valid) input.validity = said;
  return input;
}

}  // namespace softgrip::drivers
