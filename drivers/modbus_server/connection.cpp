#include "drivers/modbus_server/connection.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace softgrip::modbus {
namespace {

// Largest number of parts of replies in the queue of one client. If a client does not read its replies, the
// queue exceeds this number, and the server disconnects the client.
constexpr std::size_t max_outgoing = 1024;

bool would_block(int error) {
  return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

}  // namespace

bool Connection::receive(const Serve& serve) {
  std::array<std::uint8_t, 2048> buffer;
  const ssize_t count = ::read(descriptor_.get(), buffer.data(), buffer.size());
  if (count == 0) return false;
  if (count < 0) return would_block(errno);
  take(std::span(buffer).first(static_cast<std::size_t>(count)));
  while (const auto request = next_request()) {
    if (closing_) continue;
    queue(*request, serve(*request), Clock::now());
  }
  return !broken() && outgoing_.size() <= max_outgoing && send_due(Clock::now());
}

void Connection::take(std::span<const std::uint8_t> bytes) {
  if (auto* const network = std::get_if<RequestStream>(&stream_)) {
    network->append(bytes);
  } else {
    std::get<RtuRequestStream>(stream_).append(bytes, Clock::now());
  }
}

std::optional<Request> Connection::next_request() {
  return std::visit([](auto& stream) { return stream.next(); }, stream_);
}

bool Connection::broken() const {
  const auto* const network = std::get_if<RequestStream>(&stream_);
  return network != nullptr && network->broken();
}

void Connection::queue(const Request& request, const Reply& reply, Clock::time_point now) {
  // A pseudo-terminal transmits without delay. Therefore, the server delays the reply by the time that a real
  // serial line needs to transmit request and reply.
  constexpr std::size_t unit_and_checksum = 3;
  std::size_t bytes = request.pdu.size() + unit_and_checksum;
  for (const Piece& piece : reply.pieces) bytes += piece.bytes.size();
  const Clock::time_point earliest = now + wire_time_.character * static_cast<std::int64_t>(bytes) +
                                     wire_time_.silence + wire_time_.turnaround;
  for (const Piece& piece : reply.pieces) {
    const Clock::time_point due = earliest + piece.after;
    const auto place =
        std::upper_bound(outgoing_.begin(), outgoing_.end(), due,
                         [](Clock::time_point time, const Outgoing& other) { return time < other.due; });
    outgoing_.insert(place, {due, piece.bytes});
  }
  closing_ = closing_ || reply.disconnect;
}

bool Connection::send_due(Clock::time_point now) {
  blocked_ = false;
  while (!outgoing_.empty() && outgoing_.front().due <= now) {
    Bytes& bytes = outgoing_.front().bytes;
    const ssize_t count = ::write(descriptor_.get(), bytes.data(), bytes.size());
    if (count < 0 && !would_block(errno)) return false;
    if (count > 0) bytes.erase(bytes.begin(), bytes.begin() + count);
    if (!bytes.empty()) {
      blocked_ = true;
      return true;
    }
    outgoing_.erase(outgoing_.begin());
  }
  return !(closing_ && outgoing_.empty());
}

std::optional<Clock::time_point> Connection::next_due() const {
  if (outgoing_.empty()) return std::nullopt;
  return outgoing_.front().due;
}

}  // namespace softgrip::modbus
