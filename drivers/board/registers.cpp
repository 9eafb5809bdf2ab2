#include "drivers/board/registers.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace softgrip::drivers {
namespace {

bool is_high_first(WordOrder order) noexcept {
  return order == WordOrder::high_first || order == WordOrder::high_first_bytes_swapped;
}

/// Converts a register from the byte order of this machine to the byte order of the board. A second call with
/// the result restores the original value.
std::uint16_t ordered(std::uint16_t word, WordOrder order) noexcept {
  const bool swapped =
      order == WordOrder::high_first_bytes_swapped || order == WordOrder::low_first_bytes_swapped;
  return swapped ? static_cast<std::uint16_t>(word << 8 | word >> 8) : word;
}

std::uint32_t joined(std::span<const std::uint16_t> words, WordOrder order) noexcept {
  const std::uint32_t first = ordered(words[0], order);
  const std::uint32_t second = ordered(words[1], order);
  return is_high_first(order) ? first << 16 | second : second << 16 | first;
}

void split(std::uint32_t value, WordOrder order, std::span<std::uint16_t> words) noexcept {
  const std::uint16_t high = ordered(static_cast<std::uint16_t>(value >> 16), order);
  const std::uint16_t low = ordered(static_cast<std::uint16_t>(value & 0xffffU), order);
  words[0] = is_high_first(order) ? high : low;
  words[1] = is_high_first(order) ? low : high;
}

template <class Whole>
Whole saturated(double raw) noexcept {
  if (std::isnan(raw)) return 0;
  constexpr auto lower = static_cast<double>(std::numeric_limits<Whole>::min());
  constexpr auto upper = static_cast<double>(std::numeric_limits<Whole>::max());
  return static_cast<Whole>(std::clamp(std::round(raw), lower, upper));
}

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

double decode(std::span<const std::uint16_t> words, RegisterKind kind, WordOrder order) noexcept {
  switch (kind) {
    case RegisterKind::uint16:
      return ordered(words[0], order);
    case RegisterKind::int16:
      return static_cast<std::int16_t>(ordered(words[0], order));
    case RegisterKind::uint32:
      return joined(words, order);
    case RegisterKind::int32:
      return static_cast<std::int32_t>(joined(words, order));
    case RegisterKind::float32:
      return static_cast<double>(std::bit_cast<float>(joined(words, order)));
  }
  return std::numeric_limits<double>::quiet_NaN();
}

void encode(double raw, RegisterKind kind, WordOrder order, std::span<std::uint16_t> words) noexcept {
  switch (kind) {
    case RegisterKind::uint16:
      words[0] = ordered(saturated<std::uint16_t>(raw), order);
      return;
    case RegisterKind::int16:
      words[0] = ordered(static_cast<std::uint16_t>(saturated<std::int16_t>(raw)), order);
      return;
    case RegisterKind::uint32:
      split(saturated<std::uint32_t>(raw), order, words);
      return;
    case RegisterKind::int32:
      split(static_cast<std::uint32_t>(saturated<std::int32_t>(raw)), order, words);
      return;
    case RegisterKind::float32:
      split(std::bit_cast<std::uint32_t>(static_cast<float>(std::isnan(raw) ? 0.0 : raw)), order, words);
      return;
  }
}

double quantised_raw(const TerminalBlock& terminals, double electrical) noexcept {
  const double raw = std::clamp(terminals.scaling.x_at(electrical), terminals.raw_min, terminals.raw_max);
  const double span = terminals.raw_max - terminals.raw_min;
  double quantised = raw;
  if (terminals.bits > 0 && span > 0) {
    const double step = span / (std::exp2(terminals.bits) - 1);
    quantised = terminals.raw_min + std::round((raw - terminals.raw_min) / step) * step;
  }
  return terminals.registers.kind == RegisterKind::float32 ? quantised : std::round(quantised);
}

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
