#include "tools/web/site.h"

#include <algorithm>
#include <cstring>

namespace softgrip::web {

namespace {

/// A stream in memory that contains a request and receives the response, as cpp-httplib requires. It behaves
/// like a connection whose client has sent a complete request and waits for the response.
class MemoryStream final : public httplib::Stream {
 public:
  explicit MemoryStream(std::string_view request) : unread_(request) {}

  [[nodiscard]] bool is_readable() const override { return !unread_.empty(); }
  [[nodiscard]] bool is_writable() const override { return true; }
  ssize_t read(char* bytes, size_t size) override {
    const std::size_t count = std::min(size, unread_.size());
    std::memcpy(bytes, unread_.data(), count);
    unread_.remove_prefix(count);
    return static_cast<ssize_t>(count);
  }
  ssize_t write(const char* bytes, size_t size) override {
    written_.append(bytes, size);
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  [[nodiscard]] socket_t socket() const override { return -1; }

  [[nodiscard]] std::string take() { return std::move(written_); }

 private:
  std::string_view unread_;
  std::string written_;
};

/// Removes the parts of a request that would make the response expensive. With overlapping byte ranges, a
/// client could make a large response of a small file. With Accept-Encoding, cpp-httplib would compress the
/// response, and the compression of a file of the page takes more than 1 s.
void remove_expensive_parts(httplib::Request& request) {
  request.ranges.clear();
  request.headers.erase("Accept-Encoding");
}

}  // namespace

std::string HttpEngine::answer(std::string_view request) {
  MemoryStream stream(request);
  bool closed = false;
#if SOFTGRIP_HTTPLIB_ADDRESSES
  process_request(stream, {}, 0, {}, 0, true, closed, remove_expensive_parts);
#else
  process_request(stream, true, closed, remove_expensive_parts);
#endif
  return stream.take();
}

}  // namespace softgrip::web
