#include "tools/web/client.h"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

#include "tools/web/request_frame.h"

namespace softgrip::web {

bool Client::receive() {
  std::array<char, 4096> bytes;
  // Largest number of reads per call. It is sufficient for a complete request, and it limits the time for a
  // client that sends without end.
  constexpr std::size_t most_reads = 2 * (longest_head + longest_body) / bytes.size();
  for (std::size_t reads = 0; reads < most_reads;) {
    const ssize_t count = ::recv(socket_.get(), bytes.data(), bytes.size(), 0);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK;
    if (count == 0) {
      // Some clients close their sending side after the request and then wait for the response, so their
      // connection is kept. A browser that reads a stream closes its side when the page is closed, so the
      // stream is ended.
      const bool known = said_all_;
      said_all_ = true;
      return !known && phase_ != Phase::following;
    }
    // Bytes are stored while the request is incomplete. All bytes after the request are discarded.
    if (phase_ == Phase::asking && in_.size() < longest_head + longest_body)
      in_.append(bytes.data(), static_cast<std::size_t>(count));
    if (static_cast<std::size_t>(count) < bytes.size()) return true;
    ++reads;
  }
  return true;
}

bool Client::send_on(Nanoseconds now) {
  const std::size_t end = std::min(out_.size(), sent_ + most_at_once);
  while (sent_ < end) {
    const ssize_t count = ::send(socket_.get(), out_.data() + sent_, end - sent_, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK;
    sent_ += static_cast<std::size_t>(count);
    moved_at_ = now;
  }
  if (sent_ < out_.size()) return true;
  std::string().swap(out_);  // swap() also frees the memory of the buffer, because the first message of a
                             // stream is large
  sent_ = 0;
  if (phase_ != Phase::answering) return true;
  // shutdown() announces the end of the response to the client. close() is not called here, because the
  // system discards the response if a socket with unread input is closed.
  ::shutdown(socket_.get(), SHUT_WR);
  return false;
}

bool Client::late(Nanoseconds now) const noexcept {
  switch (phase_) {
    case Phase::asking:
      return now - came_at_ > longest_question;
    case Phase::waiting:
      return false;
    case Phase::answering:
    case Phase::loading:
      return now - moved_at_ > longest_pause || now - answered_at_ > longest_answer;
    case Phase::following:
      return has_to_send() && now - moved_at_ > longest_pause;
  }
  return true;
}

void Client::answer(std::string bytes, Phase next, Nanoseconds now) {
  phase_ = next;
  std::string().swap(in_);
  out_ = std::move(bytes);
  moved_at_ = answered_at_ = now;
}

bool Client::add(std::string_view bytes) {
  if (unsent() + bytes.size() > most_kept) return false;
  out_.erase(0, sent_);
  sent_ = 0;
  out_ += bytes;
  return true;
}

}  // namespace softgrip::web
