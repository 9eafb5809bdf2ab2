#include "tools/rig/connection.h"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace softgrip::tools::rig {
namespace {

// A client that does not read its replies is cut off before they pile up.
constexpr std::size_t max_outgoing = 1024;

bool would_block(int error) {
  return error == EAGAIN || error == EWOULDBLOCK || error == EINTR;
}

}  // namespace

bool Connection::receive(const Serve& serve) {
  std::array<std::uint8_t, 2048> buffer;
  const ssize_t count = ::recv(socket_.get(), buffer.data(), buffer.size(), 0);
  if (count == 0) return false;
  if (count < 0) return would_block(errno);
  stream_.append(std::span(buffer).first(static_cast<std::size_t>(count)));
  while (const auto request = stream_.next()) {
    if (closing_) continue;
    queue(serve(*request), Clock::now());
  }
  return !stream_.broken() && outgoing_.size() <= max_outgoing && send_due(Clock::now());
}

void Connection::queue(const Reply& reply, Clock::time_point now) {
  for (const Piece& piece : reply.pieces) {
    const Clock::time_point due = now + piece.after;
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
    const ssize_t count = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
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

}  // namespace softgrip::tools::rig
