#pragma once
// Uses cpp-httplib as a function from the bytes of a request to the bytes of its response. Its sockets and
// its thread per client are not used, so that a slow client occupies no thread and delays no other client.

#include <string>
#include <string_view>

#include <httplib.h>

namespace softgrip::web {

class HttpEngine : public httplib::Server {
 public:
  /// Returns the response to a complete request. No input of a client makes it throw.
  [[nodiscard]] std::string answer(std::string_view request);
};

}  // namespace softgrip::web
