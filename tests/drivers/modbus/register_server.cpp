#include "tests/drivers/modbus/register_server.h"

#include <utility>

namespace softgrip::drivers::test {
namespace {

RegisterServer::Request parsed(const Bytes& frame) {
  RegisterServer::Request request;
  request.function = frame.at(7);
  request.address = word(frame, 8);
  const auto words = [&frame](std::size_t at, std::size_t count) {
    std::vector<std::uint16_t> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(word(frame, at + 2 * i));
    return values;
  };
  switch (request.function) {
    case 5:
    case 6:
      request.write_address = request.address;
      request.written = words(10, 1);
      break;
    case 16:
      request.write_address = request.address;
      request.written = words(13, word(frame, 10));
      break;
    case 23:
      request.count = word(frame, 10);
      request.write_address = word(frame, 12);
      request.written = words(17, word(frame, 14));
      break;
    default:
      request.count = word(frame, 10);
      break;
  }
  return request;
}

std::uint16_t value_in(const std::map<std::uint16_t, std::uint16_t>& table, std::size_t address) {
  const auto found = table.find(static_cast<std::uint16_t>(address));
  return found == table.end() ? std::uint16_t{0} : found->second;
}

}  // namespace

RegisterServer::RegisterServer()
    : server_([this](Peer& peer, const Bytes& frame, std::size_t) {
        const Bytes reply = answer(frame);
        std::chrono::milliseconds delay{0};
        {
          const std::lock_guard lock(mutex_);
          delay = delay_;
        }
        if (delay.count() > 0) peer.wait(delay);
        peer.send(reply);
      }) {}

void RegisterServer::set_holding(std::uint16_t address, std::uint16_t value) {
  const std::lock_guard lock(mutex_);
  holding_[address] = value;
}
void RegisterServer::set_input(std::uint16_t address, std::uint16_t value) {
  const std::lock_guard lock(mutex_);
  input_[address] = value;
}
void RegisterServer::set_coil(std::uint16_t address, std::uint16_t value) {
  const std::lock_guard lock(mutex_);
  coils_[address] = value;
}
std::uint16_t RegisterServer::holding(std::uint16_t address) {
  const std::lock_guard lock(mutex_);
  return value_in(holding_, address);
}
std::uint16_t RegisterServer::coil(std::uint16_t address) {
  const std::lock_guard lock(mutex_);
  return value_in(coils_, address);
}
void RegisterServer::mirror_inputs(bool mirrored) {
  const std::lock_guard lock(mutex_);
  mirrored_ = mirrored;
}
void RegisterServer::refuse(std::optional<std::uint8_t> function, std::uint8_t code) {
  const std::lock_guard lock(mutex_);
  refused_ = function;
  refusal_ = code;
}
void RegisterServer::ignore_writes(bool ignored) {
  const std::lock_guard lock(mutex_);
  writes_ignored_ = ignored;
}
void RegisterServer::on_request(std::function<void(RegisterServer&, const Request&)> hook) {
  const std::lock_guard lock(mutex_);
  hook_ = std::move(hook);
}
void RegisterServer::delay(std::chrono::milliseconds duration) {
  const std::lock_guard lock(mutex_);
  delay_ = duration;
}
std::vector<RegisterServer::Request> RegisterServer::take_requests() {
  const std::lock_guard lock(mutex_);
  return std::exchange(requests_, {});
}

Bytes RegisterServer::answer(const Bytes& frame) {
  const std::lock_guard lock(mutex_);
  const Request request = parsed(frame);
  requests_.push_back(request);
  if (hook_) hook_(*this, request);
  if (refused_ == request.function) return exception_reply(frame, refusal_);
  return carry_out(frame, request);
}

Bytes RegisterServer::read_registers(const std::map<std::uint16_t, std::uint16_t>& table,
                                     const Request& request) {
  Bytes pdu(2U + 2U * request.count);
  pdu[0] = request.function;
  pdu[1] = static_cast<std::uint8_t>(2 * request.count);
  for (std::size_t i = 0; i < request.count; ++i)
    set_word(pdu, 2 + 2 * i, value_in(table, request.address + i));
  return pdu;
}

Bytes RegisterServer::read_bits(const Request& request) {
  Bytes pdu(2U + (request.count + 7U) / 8U);
  pdu[0] = request.function;
  pdu[1] = static_cast<std::uint8_t>(pdu.size() - 2);
  for (std::size_t i = 0; i < request.count; ++i) {
    if (value_in(coils_, request.address + i) == 0) continue;
    pdu[2 + i / 8] = static_cast<std::uint8_t>(pdu[2 + i / 8] | 1U << (i % 8));
  }
  return pdu;
}

Bytes RegisterServer::carry_out(const Bytes& frame, const Request& request) {
  if (!writes_ignored_) {
    for (std::size_t i = 0; i < request.written.size(); ++i) {
      const auto address = static_cast<std::uint16_t>(request.write_address + i);
      (request.function == 5 ? coils_ : holding_)[address] = request.written[i];
    }
  }
  switch (request.function) {
    case 1:
    case 2:
      return frame_for(frame, read_bits(request));
    case 3:
    case 23:
      return frame_for(frame, read_registers(holding_, request));
    case 4:
      return frame_for(frame, read_registers(mirrored_ ? holding_ : input_, request));
    case 5:
    case 6:
    case 16:
      return frame_for(frame, {frame.at(7), frame.at(8), frame.at(9), frame.at(10), frame.at(11)});
    default:
      return exception_reply(frame, 1);
  }
}

}  // namespace softgrip::drivers::test
