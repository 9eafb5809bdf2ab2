#include "simulation/emulator/wire.h"

#include <modbus/modbus.h>

#include <algorithm>
#include <chrono>

#include "drivers/modbus/rtu_frame.h"
#include "simulation/emulator/wire.h"

namespace softgrip::simulation {
namespace {

Reply at_once(Bytes bytes) {
  return {{{std::chrono::nanoseconds{0}, std::move(bytes)}}, false};
}

Reply dripped(const Bytes& whole, double interval_s) {
  Reply reply;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    reply.pieces.push_back({std::chrono::nanoseconds{nanoseconds(interval_s)} * i, Bytes{whole[i]}});
  }
  return reply;
}

Reply longer_than_it_is(Wire wire, const Request& request, const Bytes& pdu) {
  Bytes whole = frame_on(wire, request.transaction, request.unit, pdu);
  if (wire == Wire::rtu) {
    whole.resize(whole.size() + drivers::max_stray_bytes + 1);
    return at_once(std::move(whole));
  }
  const auto length = static_cast<std::uint16_t>(word_at(whole, 4) + 1);
  drivers::put_word(whole, 4, length);
  return at_once(std::move(whole));
}

/// Returns the reply with the transaction id of the next request. On a serial line, frames have no
/// transaction id, so the reply gets a wrong checksum instead.
Reply of_another_question(Wire wire, const Request& request, const Bytes& pdu) {
  const auto next_transaction = static_cast<std::uint16_t>(request.transaction + 1);
  Bytes whole = frame_on(wire, next_transaction, request.unit, pdu);
  if (wire == Wire::rtu) whole.back() = static_cast<std::uint8_t>(whole.back() + 1);
  return at_once(std::move(whole));
}

/// Returns the larger of two numbers: the registers that a request reads, and the registers that it writes.
/// Returns 0 for requests that read or write bits.
std::size_t most_registers_in(const Bytes& pdu) noexcept {
  constexpr std::size_t counted = 5;  // size of function code, address and number of registers
  constexpr std::size_t counted_twice = 9;
  switch (pdu[0]) {
    case MODBUS_FC_READ_HOLDING_REGISTERS:
    case MODBUS_FC_READ_INPUT_REGISTERS:
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      return pdu.size() < counted ? 0 : word_at(pdu, 3);
    case MODBUS_FC_WRITE_AND_READ_REGISTERS:
      return pdu.size() < counted_twice ? 0 : std::max(word_at(pdu, 3), word_at(pdu, 7));
    default:
      return 0;
  }
}

Reply between_strays(const FaultSpec& fault, const Bytes& whole) {
  Bytes bytes(fault.before, 0);
  bytes.insert(bytes.end(), whole.begin(), whole.end());
  bytes.resize(bytes.size() + fault.behind, 0);
  return at_once(std::move(bytes));
}

}  // namespace

Reply good_reply(Wire wire, const Request& request, const Bytes& pdu) {
  return at_once(frame_on(wire, request.transaction, request.unit, pdu));
}

bool touches(const FaultSpec& fault, const Request& request, Nanoseconds connected_for) noexcept {
  if (fault.kind == FaultKind::settling) return connected_for < nanoseconds(fault.settle_s);
  if (fault.kind == FaultKind::few_registers) return most_registers_in(request.pdu) > fault.most;
  return true;
}

bool carried_out(FaultKind kind) noexcept {
  return kind != FaultKind::lost_request && kind != FaultKind::exception_reply &&
         kind != FaultKind::settling && kind != FaultKind::few_registers && kind != FaultKind::disconnect;
}

Reply spoiled_reply(Wire wire, const FaultSpec& fault, const Request& request, const Bytes& pdu) {
  const Bytes whole = frame_on(wire, request.transaction, request.unit, pdu);
  const auto next_unit = static_cast<std::uint8_t>(request.unit + 1);
  switch (fault.kind) {
    case FaultKind::lost_request:
    case FaultKind::no_reply:
    case FaultKind::settling:
      return {};
    case FaultKind::late_reply:
      return {{{std::chrono::nanoseconds{nanoseconds(fault.delay_s)}, whole}}, false};
    case FaultKind::dripped_reply:
      return dripped(whole, fault.interval_s);
    case FaultKind::cut_reply:
      return at_once(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(whole.size() / 2)));
    case FaultKind::repeated_reply:
      return {{{{}, whole}, {{}, whole}}, false};
    case FaultKind::wrong_unit:
      return at_once(frame_on(wire, request.transaction, next_unit, pdu));
    case FaultKind::wrong_transaction:
      return of_another_question(wire, request, pdu);
    case FaultKind::wrong_length:
      return longer_than_it_is(wire, request, pdu);
    case FaultKind::exception_reply:
      return good_reply(wire, request, exception_reply(request.pdu[0], fault.code));
    case FaultKind::few_registers:
      return good_reply(wire, request, exception_reply(request.pdu[0], MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE));
    case FaultKind::stray_bytes:
      return between_strays(fault, whole);
    case FaultKind::disconnect:
      return {{}, true};
    default:
      return good_reply(wire, request, pdu);
  }
}

}  // namespace softgrip::simulation
