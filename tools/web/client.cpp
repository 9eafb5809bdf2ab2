#include "tools/web/client.h"

#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <utility>

#include "tools/web/request_frame.h"

namespace softgrip::web {

bool Client::receive() {
  std::array<char, 4096> bytes;
  for (;;) {
    const ssize_t count = ::recv(socket_.get(), bytes.data(), bytes.size(), 0);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK;
    if (count == 0) return false;
    // Whatever comes behind the request is nobody's.
    if (phase_ == Phase::asking && in_.size() < longest_head + longest_body)
      in_.append(bytes.data(), static_cast<std::size_t>(count));
    if (static_cast<std::size_t>(count) < bytes.size()) return true;
  }
}

bool Client::send_on(Nanoseconds now) {
  while (sent_ < out_.size()) {
    const ssize_t count = ::send(socket_.get(), out_.data() + sent_, out_.size() - sent_, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK;
    sent_ += static_cast<std::size_t>(count);
    moved_at_ = now;
  }
  out_.clear();
  sent_ = 0;
  if (phase_ != Phase::answering) return true;
  // He is told that this is all; what he still says would make the system throw away what he has not read.
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
      return now - moved_at_ > longest_pause || now - answered_at_ > longest_answer;
    case Phase::following:
      return has_to_send() && now - moved_at_ > longest_pause;
  }
  return true;
}

void Client::answer(std::string bytes, bool follows, Nanoseconds now) {
  phase_ = follows ? Phase::following : Phase::answering;
  out_ = std::move(bytes);
  moved_at_ = answered_at_ = now;
}

bool Client::add(std::string_view messages) {
  if (out_.size() - sent_ + messages.size() > most_kept) return false;
  out_.erase(0, sent_);
  sent_ = 0;
  out_ += messages;
  return true;
}

}  // namespace softgrip::web
