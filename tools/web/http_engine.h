#pragma once
// Uses cpp-httplib as a function that converts the bytes of a request to the bytes of its response. The
// sockets and the threads of the library are not used, so that a slow client occupies no thread and delays no
// other client.

#include <string>
#include <string_view>

#include <httplib.h>

namespace softgrip::web {

class HttpEngine : public httplib::Server {
 public:
  /// Returns the response to a complete request. It throws no exception for any input of a client.
  [[nodiscard]] std::string answer(std::string_view request);
};

}  // namespace softgrip::web
