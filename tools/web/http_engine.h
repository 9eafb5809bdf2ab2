#pragma once
// Uses cpp-httplib as a function that converts the bytes of a request to the bytes of its response. The
// sockets and threads of cpp-httplib are not used, so a slow client occupies no thread and delays no other
// client.

#include <string>
#include <string_view>

#include <httplib.h>

namespace softgrip::web {

class HttpEngine : public httplib::Server {
 public:
  /// Returns the response to a complete request. Throws no exception for any bytes that a client sends.
  [[nodiscard]] std::string answer(std::string_view request);
};

}  // namespace softgrip::web
