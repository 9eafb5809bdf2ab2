#include "drivers/modbus_server/requests.h"

#include <modbus/modbus.h>

#include <algorithm>

#include "drivers/modbus/modbus_message.h"
#include "drivers/modbus/rtu_frame.h"

namespace softgrip::modbus {
namespace {

using drivers::mbap_size;
using drivers::rtu_overhead;

// Largest number of received bytes of one client that wait to be processed. If more bytes wait, the
// connection is closed. Complete requests are removed after each reception, so a correct client never reaches
// this number.
constexpr std::size_t max_pending = 16 * drivers::max_frame;

constexpr std::chrono::milliseconds no_lump{100};

/// Returns the size of the serial frame at the start of `bytes`; 0 if too few bytes have arrived to determine
/// the size. For a function code that no board of this project supports, returns the number of all bytes, so
/// that the server can respond with an exception.
std::size_t rtu_request_size(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 2) return 0;
  constexpr std::size_t crc_size = 2;
  constexpr std::size_t fixed_request = 6 + crc_size;  // size of a request with unit id, function code, two
                                                       // words and CRC
  constexpr std::size_t count_of_multiple = 6;
  constexpr std::size_t count_of_read_write = 10;
  const auto counted = [&](std::size_t at) -> std::size_t {
    return bytes.size() <= at ? 0 : at + 1 + bytes[at] + crc_size;
  };
  switch (bytes[1]) {
    case MODBUS_FC_READ_COILS:
    case MODBUS_FC_READ_DISCRETE_INPUTS:
    case MODBUS_FC_READ_HOLDING_REGISTERS:
    case MODBUS_FC_READ_INPUT_REGISTERS:
    case MODBUS_FC_WRITE_SINGLE_COIL:
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
      return fixed_request;
    case MODBUS_FC_WRITE_MULTIPLE_COILS:
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      return counted(count_of_multiple);
    case MODBUS_FC_WRITE_AND_READ_REGISTERS:
      return counted(count_of_read_write);
    default:
      return bytes.size() < 1 + rtu_overhead ? 0 : bytes.size();
  }
}

/// Removes the first `frame` bytes and returns the request in them. The bytes from `begin` to `end` are the
/// PDU (function code and data).
Request taken_from(Bytes& pending, std::size_t frame, std::size_t begin, std::size_t end) {
  const auto at = [&](std::size_t index) { return pending.begin() + static_cast<std::ptrdiff_t>(index); };
  Request request{0, pending[begin - 1], Bytes(at(begin), at(end))};
  pending.erase(pending.begin(), at(frame));
  return request;
}

}  // namespace

void RequestStream::append(std::span<const std::uint8_t> bytes) {
  if (broken_) return;
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
  if (pending_.size() > max_pending) broken_ = true;
}

std::optional<Request> RequestStream::next() {
  if (broken_ || pending_.size() < mbap_size) return std::nullopt;
  const std::uint16_t transaction = word_at(pending_, 0);
  const std::uint16_t protocol = word_at(pending_, 2);
  const std::size_t length = word_at(pending_, 4);  // length field of the header: size of the unit id and the
                                                    // PDU
  if (protocol != 0 || length < 2 || length > max_pdu + 1) {
    broken_ = true;
    return std::nullopt;
  }
  const std::size_t whole = mbap_size - 1 + length;
  if (pending_.size() < whole) return std::nullopt;
  Request request = taken_from(pending_, whole, mbap_size, whole);
  request.transaction = transaction;
  return request;
}

void RtuRequestStream::append(std::span<const std::uint8_t> bytes, Clock::time_point now) {
  if (now - last_byte_ > no_lump) pending_.clear();
  last_byte_ = now;
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
}

std::optional<Request> RtuRequestStream::next() {
  const std::size_t size = rtu_request_size(pending_);
  const bool begun = size == 0 || (size <= drivers::max_rtu_frame && pending_.size() < size);
  if (begun) return std::nullopt;
  if (size > drivers::max_rtu_frame ||
      !drivers::crc_holds(std::span<const std::uint8_t>(pending_).first(size))) {
    pending_.clear();
    return std::nullopt;
  }
  return taken_from(pending_, size, 1, size - (rtu_overhead - 1));
}

Bytes frame_on(Wire wire, std::uint16_t transaction, std::uint8_t unit, std::span<const std::uint8_t> pdu) {
  const std::size_t begin = wire == Wire::tcp ? mbap_size : 1;
  Bytes frame(pdu.size() + (wire == Wire::tcp ? mbap_size : rtu_overhead));
  std::copy(pdu.begin(), pdu.end(), frame.begin() + static_cast<std::ptrdiff_t>(begin));
  if (wire == Wire::tcp) {
    drivers::put_mbap(frame, pdu.size(), transaction, unit);
  } else {
    drivers::put_rtu_ends(frame, pdu.size(), unit);
  }
  return frame;
}

}  // namespace softgrip::modbus
