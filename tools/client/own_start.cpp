#include "tools/client/daemon_client.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <random>

#include "control/elements/fault.h"

namespace softgrip::tools {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view capability = "start_id";

bool accepts(const Json& reply) {
  const auto ok = reply.find("ok");
  return ok != reply.end() && ok->is_boolean() && ok->get<bool>();
}

}  // namespace

std::string new_start_id() {
  std::random_device random;
  std::string id;
  for (int words = 0; words < 4; ++words) {
    std::array<char, 9> digits{};
    std::snprintf(digits.data(), digits.size(), "%08x", static_cast<unsigned>(random()));
    id += digits.data();
  }
  return id;
}

std::optional<ClientFailure> check_start_id_support(DaemonClient& client) {
  const auto hello = client.call({{"command", "hello"}});
  if (!hello) return hello.error();
  const Json names = hello->value("capabilities", Json::array());
  if (std::find(names.begin(), names.end(), Json(capability)) != names.end()) return std::nullopt;
  return ClientFailure{
      ExitCode::state_refused,
      "softgripd is older than this program and cannot stop the sequence of a single client, so no sequence "
      "was started. Restart the daemon (systemctl restart softgripd)"};
}

Json stop_request_for(const std::string& start_id) {
  return {{"command", "stop"}, {"start_id", start_id}};
}

bool confirms_stop(const Json& reply) {
  return accepts(reply) || text_at(object_at(object_at(reply, "error"), "refusal"), "name") ==
                               control::name_of(control::RefusalCode::named_start_not_running);
}

bool refuses_start(const Json& reply) {
  constexpr std::array<std::string_view, 8> refusals{
      "refused", "sequence_refused", "busy", "owned", "abandoned", "not_allowed", "bad_request", "too_long"};
  const std::string code = text_at(object_at(reply, "error"), "code");
  return !accepts(reply) && std::find(refusals.begin(), refusals.end(), code) != refusals.end();
}

}  // namespace softgrip::tools
