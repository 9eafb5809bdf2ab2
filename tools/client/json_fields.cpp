#include "tools/client/json_fields.h"

#include <nlohmann/json.hpp>

#include "base/json.h"
#include "document/problem.h"

namespace softgrip::tools {

using Json = nlohmann::ordered_json;

std::string text_at(const Json& json, const char* key, std::size_t most) {
  const Json& value = json_member(json, key);
  return value.is_string() ? document::shown(value.get<std::string>(), most) : "-";
}

std::optional<double> number_at(const Json& json, const char* key) {
  const Json& value = json_member(json, key);
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

const Json& object_at(const Json& json, const char* key) {
  static const Json empty = Json::object();
  const Json& value = json_member(json, key);
  return value.is_object() ? value : empty;
}

}  // namespace softgrip::tools
