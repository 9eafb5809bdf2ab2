// Fuzz target of softgrip-web: for any bytes of a client, softgrip-web refuses the request, answers it or
// waits for more bytes.
//
//   Command: scripts/fuzz.sh web_request_fuzz 30

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "tools/web/client.h"
#include "tools/web/site.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace softgrip::web;
  static Settings settings;
  settings.without_token = Role::operate;
  static Gate gate(settings, {});
  static LiveState state;
  static const ServerCounts counts;
  static Site site(settings, gate, state, counts, "chart");

  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const Frame frame = frame_of(bytes);
  if (frame.state == Frame::State::incomplete) {
    // For an incomplete request, the server must not store more bytes than the longest head plus the longest
    // body.
    if (size >= longest_head + longest_body) std::abort();
    return 0;
  }
  if (frame.state == Frame::State::refused) {
    if (frame.status < 400 || frame.status > 599) std::abort();
    return 0;
  }
  if (frame.size > size) std::abort();
  const Outcome outcome = site.serve(bytes.substr(0, frame.size), 0);
  // The server must answer every request immediately, except a command, whose answer comes from the daemon.
  if (!outcome.command && !outcome.bytes.starts_with("HTTP/1.1 ")) std::abort();
  if (outcome.command && !(*outcome.command)["command"].is_string()) std::abort();
  return 0;
}
