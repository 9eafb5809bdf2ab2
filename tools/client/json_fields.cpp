#include "tools/client/json_fields.h"

#include <nlohmann/json.hpp>

#include "document/problem.h"

namespace softgrip::tools {

using Json = nlohmann::ordered_json;

std::string text_at(const Json& json, const char* key, std::size_t most) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? document::shown(found->get<std::string>(), most) : "-";
}

std::optional<double> number_at(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

const Json& object_at(const Json& json, const char* key) {
  static const Json empty = Json::object();
  const auto found = json.find(key);
  return found != json.end() && found->is_object() ? *found : empty;
}

}  // namespace softgrip::tools
