#include "tools/web/client.h"

#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <optional>
#include <utility>

#include "tools/web/access/tokens.h"

namespace softgrip::web {
namespace {

constexpr std::string_view line_end = "\r\n";

Frame refused(int status) {
  return {Frame::State::refused, 0, status};
}

bool is_printable(char character) {
  return character >= ' ' && character <= '~';
}

bool equal_ignoring_case(std::string_view name, std::string_view lower) {
  const auto same = [](char one, char other) {
    return (one >= 'A' && one <= 'Z' ? static_cast<char>(one - 'A' + 'a') : one) == other;
  };
  return std::equal(name.begin(), name.end(), lower.begin(), lower.end(), same);
}

/// Removes the first line from the text and returns this line.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find(line_end), text.size());
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + line_end.size(), text.size()));
  return line;
}

/// Checks the first line of a request. Returns 0 if it is valid, otherwise the HTTP status of the refusal.
int check_request_line(std::string_view line) {
  const std::size_t first = line.find(' ');
  const std::size_t last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) return 400;
  const std::string_view method = line.substr(0, first);
  const std::string_view target = line.substr(first + 1, last - first - 1);
  const std::string_view version = line.substr(last + 1);
  if (version != "HTTP/1.1" && version != "HTTP/1.0") return version.starts_with("HTTP/") ? 505 : 400;
  if (target.empty() || target.front() != '/' || target.find(' ') != std::string_view::npos) return 400;
  if (target.size() > longest_target) return 414;
  const bool known = method == "GET" || method == "HEAD" || method == "POST" || method == "DELETE";
  return known ? 0 : 405;
}

struct Lengths {
  std::optional<std::size_t> body;
  std::size_t hosts = 0;
};

std::optional<std::size_t> length_in(std::string_view value) {
  std::size_t length = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), length);
  const bool whole = error == std::errc() && end == value.data() + value.size();
  return whole ? std::optional(length) : std::nullopt;
}

int check_header(std::string_view line, Lengths& lengths) {
  const std::size_t colon = line.find(':');
  const std::string_view name = line.substr(0, std::min(colon, line.size()));
  if (colon == std::string_view::npos || name.empty() ||
      !std::all_of(name.begin(), name.end(), is_name_character)) {
    return 400;
  }
  std::string_view value = line.substr(colon + 1);
  while (value.starts_with(' ')) value.remove_prefix(1);
  while (value.ends_with(' ')) value.remove_suffix(1);
  if (equal_ignoring_case(name, "transfer-encoding")) return 501;
  if (equal_ignoring_case(name, "content-encoding")) return 415;
  if (equal_ignoring_case(name, "expect")) return 417;
  if (equal_ignoring_case(name, "host")) return ++lengths.hosts > 1 ? 400 : 0;
  if (!equal_ignoring_case(name, "content-length")) return 0;
  const auto length = length_in(value);
  if (!length || lengths.body) return 400;
  lengths.body = length;
  return *length > longest_body ? 413 : 0;
}

}  // namespace

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
      const bool already_closed = input_closed_;
      input_closed_ = true;
      return !already_closed && phase_ != Phase::streaming;
    }
    // Bytes are stored while the request is incomplete. All bytes after the request are discarded.
    if (phase_ == Phase::receiving && in_.size() < longest_head + longest_body)
      in_.append(bytes.data(), static_cast<std::size_t>(count));
    if (static_cast<std::size_t>(count) < bytes.size()) return true;
    ++reads;
  }
  return true;
}

bool Client::send_pending(Nanoseconds now) {
  const std::size_t end = std::min(out_.size(), sent_ + max_per_send);
  while (sent_ < end) {
    const ssize_t count = ::send(socket_.get(), out_.data() + sent_, end - sent_, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno == EAGAIN || errno == EWOULDBLOCK;
    sent_ += static_cast<std::size_t>(count);
    last_progress_at_ = now;
  }
  if (sent_ < out_.size()) return true;
  std::string().swap(out_);  // swap() also frees the memory of the buffer, because the first message of a
                             // stream is large
  sent_ = 0;
  if (phase_ != Phase::responding) return true;
  // shutdown() announces the end of the response to the client. close() is not called here, because the
  // system discards the response if a socket with unread input is closed.
  ::shutdown(socket_.get(), SHUT_WR);
  return false;
}

bool Client::timed_out(Nanoseconds now) const noexcept {
  switch (phase_) {
    case Phase::receiving:
      return now - connected_at_ > request_timeout;
    case Phase::waiting:
      return false;
    case Phase::responding:
    case Phase::sending_file:
      return now - last_progress_at_ > stall_timeout || now - responded_at_ > response_timeout;
    case Phase::streaming:
      return has_unsent() && now - last_progress_at_ > stall_timeout;
  }
  return true;
}

void Client::respond(std::string bytes, Phase next, Nanoseconds now) {
  phase_ = next;
  std::string().swap(in_);
  out_ = std::move(bytes);
  last_progress_at_ = responded_at_ = now;
}

bool Client::add(std::string_view bytes) {
  if (unsent() + bytes.size() > max_buffered) return false;
  out_.erase(0, sent_);
  sent_ = 0;
  out_ += bytes;
  return true;
}

Frame frame_of(std::string_view bytes) {
  constexpr std::string_view head_end = "\r\n\r\n";
  const std::size_t end = bytes.substr(0, longest_head).find(head_end);
  const std::string_view known = bytes.substr(0, std::min(end, longest_head));
  for (std::size_t i = 0; i < known.size(); ++i) {
    const bool ends_line = known[i] == '\r' ? i + 1 == known.size() || known[i + 1] == '\n'
                                            : known[i] == '\n' && i > 0 && known[i - 1] == '\r';
    if (!is_printable(known[i]) && !ends_line) return refused(400);
  }
  if (end == std::string_view::npos) return bytes.size() >= longest_head ? refused(431) : Frame{};

  std::string_view head = known;
  if (const int status = check_request_line(take_line(head)); status != 0) return refused(status);
  Lengths lengths;
  for (std::size_t headers = 0; !head.empty(); ++headers) {
    if (headers == most_headers) return refused(431);
    if (const int status = check_header(take_line(head), lengths); status != 0) return refused(status);
  }
  const std::size_t size = end + head_end.size() + lengths.body.value_or(0);
  if (bytes.size() < size) return {};
  return {Frame::State::complete, size, 0};
}

}  // namespace softgrip::web
