#include "tools/client/own_start.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <random>
#include <string_view>

namespace softgrip::tools {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view capability = "start_id";

Json error_in(const Json& reply) {
  const auto error = reply.find("error");
  return error != reply.end() && error->is_object() ? *error : Json::object();
}

std::string text_in(const Json& object, const char* key) {
  const auto text = object.find(key);
  return text != object.end() && text->is_string() ? text->get<std::string>() : std::string();
}

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

std::optional<ClientFailure> cannot_name_starts(DaemonClient& client) {
  const auto hello = client.ask({{"command", "hello"}});
  if (!hello) return hello.error();
  const Json names = hello->value("capabilities", Json::array());
  if (std::find(names.begin(), names.end(), Json(capability)) != names.end()) return std::nullopt;
  return ClientFailure{
      ExitCode::state_refused,
      "this softgripd is older than this program: it cannot stop one start alone, so nothing "
      "was started. Restart the daemon (systemctl restart softgripd)"};
}

Json stop_of(const std::string& start_id) {
  return {{"command", "stop"}, {"start_id", start_id}};
}

bool confirms_stop(const Json& reply) {
  if (accepts(reply)) return true;
  const Json error = error_in(reply);
  const auto refusal = error.find("refusal");
  return refusal != error.end() && refusal->is_object() &&
         text_in(*refusal, "name") == "named_start_not_running";
}

bool refuses_start(const Json& reply) {
  constexpr std::array<std::string_view, 7> refusals{"refused",   "sequence_refused", "busy",       "owned",
                                                     "abandoned", "not_allowed",      "bad_request"};
  const std::string code = text_in(error_in(reply), "code");
  return !accepts(reply) && std::find(refusals.begin(), refusals.end(), code) != refusals.end();
}

}  // namespace softgrip::tools
