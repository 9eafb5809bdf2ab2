#include "simulation/emulator/rtu.h"

#include "drivers/modbus/rtu_frame.h"
#include "simulation/emulator/registers.h"

namespace softgrip::simulation {
namespace {

constexpr std::chrono::milliseconds no_lump{100};
constexpr std::size_t crc_size = 2;
constexpr std::size_t fixed_request = 6 + crc_size;  // unit, function, two words
constexpr std::size_t shortest_request = 2 + crc_size;

/// Bytes of the request that begins here; 0 while that cannot be known. Of a function that no board here has,
/// all there are: it wants an answer too, an exception.
std::size_t request_size(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 2) return 0;
  constexpr std::uint8_t write_coils = 0x0f;
  constexpr std::size_t count_of_multiple = 6;
  constexpr std::size_t count_of_read_write = 10;
  const auto counted = [&](std::size_t at) -> std::size_t {
    return bytes.size() <= at ? 0 : at + 1 + bytes[at] + crc_size;
  };
  switch (bytes[1]) {
    case static_cast<std::uint8_t>(Function::read_coils):
    case static_cast<std::uint8_t>(Function::read_discrete):
    case static_cast<std::uint8_t>(Function::read_holding):
    case static_cast<std::uint8_t>(Function::read_input):
    case static_cast<std::uint8_t>(Function::write_coil):
    case static_cast<std::uint8_t>(Function::write_single):
      return fixed_request;
    case write_coils:
    case static_cast<std::uint8_t>(Function::write_multiple):
      return counted(count_of_multiple);
    case static_cast<std::uint8_t>(Function::read_write):
      return counted(count_of_read_write);
    default:
      return bytes.size() < shortest_request ? 0 : bytes.size();
  }
}

}  // namespace

void RtuRequestStream::append(std::span<const std::uint8_t> bytes, Clock::time_point now) {
  if (now - last_byte_ > no_lump) pending_.clear();
  last_byte_ = now;
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
}

std::optional<Request> RtuRequestStream::next() {
  const std::size_t size = request_size(pending_);
  if (size > drivers::max_rtu_frame) {
    pending_.clear();
    return std::nullopt;
  }
  if (size == 0 || pending_.size() < size) return std::nullopt;
  const std::size_t checked = size - crc_size;
  const std::uint16_t crc = drivers::crc16(std::span<const std::uint8_t>(pending_).first(checked));
  const auto sent = static_cast<std::uint16_t>(pending_[checked + 1] << 8U | pending_[checked]);
  if (crc != sent) {
    pending_.clear();
    return std::nullopt;
  }
  const auto begin = pending_.begin();
  Request request{0, pending_[0], Bytes(begin + 1, begin + static_cast<std::ptrdiff_t>(checked))};
  pending_.erase(begin, begin + static_cast<std::ptrdiff_t>(size));
  return request;
}

Bytes rtu_frame(std::uint8_t unit, std::span<const std::uint8_t> pdu) {
  Bytes bytes{unit};
  bytes.insert(bytes.end(), pdu.begin(), pdu.end());
  const std::uint16_t crc = drivers::crc16(bytes);
  bytes.push_back(static_cast<std::uint8_t>(crc & 0xffU));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8U));
  return bytes;
}

}  // namespace softgrip::simulation
