// Fuzz target: takes arbitrary bytes as a line of a client. The parser must return a request, or a refusal
// with a message.
//
//   Command: scripts/fuzz.sh client_request_fuzz 30

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "daemon/socket/client_request.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  const auto request = softgrip::daemon::parse_client_request(line);
  if (!request) {
    if (request.error().message.empty()) std::abort();
    return 0;
  }
  // Other code assumes bounds for the numbers of an accepted request. The numbers must be within these
  // bounds.
  if (!(request->rate_hz >= 0.1 && request->rate_hz <= 50)) std::abort();
  if (request->limit < 1 || request->limit > 1000) std::abort();
  if (request->id.value_or(0) > (std::uint64_t{1} << 53)) std::abort();
  if (request->command == softgrip::daemon::ClientRequest::Command::start && request->sequence.empty())
    std::abort();
  return 0;
}
