#pragma once
// cpp-httplib as a function from the bytes of a request to those of its answer: its sockets and threads, one
// per client, are left alone, so that a client that is slow costs no thread and nobody else's time.

#include <string>
#include <string_view>

#include <httplib.h>

namespace softgrip::web {

class HttpEngine : public httplib::Server {
 public:
  /// What goes back to the client of a complete request. Never throws for what a client can send.
  [[nodiscard]] std::string answer(std::string_view request);
};

}  // namespace softgrip::web
