#include "tools/client/daemon_client.h"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <span>

#include "base/json.h"
#include "document/problem.h"

namespace softgrip::tools {
namespace {

using Json = nlohmann::ordered_json;

// The names in this namespace are as short as the keys of the protocol. The namespace prevents conflicts with
// other names.
namespace reply_shape {

/// Largest accepted nesting depth of a line. Messages of the daemon need five levels. The depth is limited
/// because copying and printing JSON recursively use the stack for each level.
constexpr std::size_t max_depth = 32;

/// The JSON types of a value as bits of a mask. A field may allow several types.
enum Kind : unsigned { text = 1, number = 2, count = 4, flag = 8, object = 16, list = 32, null = 64 };

struct Shape;

struct Field {
  const char* key;
  unsigned kinds;
  const Shape* inside = nullptr;  ///< required shape of the value if the value is an object, or of each
                                  ///< element if the value is a list
  bool is_required = false;
};

struct Shape {
  std::span<const Field> fields;
  bool is_whole = true;  ///< true: a value must have all required fields of the shape; false: required fields
                         ///< may be missing
};

constexpr Field problem_fields[] = {{"file", text},      {"line", count},   {"column", count},
                                    {"line_text", text}, {"message", text}, {"hint", text}};
constexpr Shape problem{problem_fields};

constexpr Field refusal_fields[] = {{"code", text}, {"name", text}};
constexpr Shape refusal{refusal_fields};

constexpr Field error_fields[] = {{"code", text, nullptr, true},
                                  {"message", text, nullptr, true},
                                  {"refusal", object, &refusal},
                                  {"problems", list, &problem}};
constexpr Shape error{error_fields};

constexpr Field event_fields[] = {{"id", count},  {"time_s", number}, {"kind", text}, {"severity", text},
                                  {"code", text}, {"request", count}, {"text", text}, {"at", text}};
constexpr Shape event{event_fields};

constexpr Field fault_fields[] = {{"code", text, nullptr, true}, {"name", text}};
constexpr Shape fault{fault_fields};

constexpr Field run_fields[] = {
    {"name", text}, {"step", count, nullptr, true}, {"steps", count}, {"ended", text | null, nullptr, true}};
constexpr Shape run{run_fields};

constexpr Field channel_fields[] = {{"result", text, nullptr, true},
                                    {"validity", text, nullptr, true},
                                    {"displacement_mm", number | null, nullptr, true},
                                    {"pressure_kpa", number | null, nullptr, true},
                                    {"command_kpa", number | null, nullptr, true},
                                    {"squeeze_kpa", number | null, nullptr, true},
                                    {"saturated", flag},
                                    {"slewing", flag}};
constexpr Shape channel{channel_fields};

constexpr Field pressure_fields[] = {{"text", text}};
constexpr Shape pressure{pressure_fields};
constexpr Field bus_fields[] = {{"connected", flag}, {"answered", flag}};
constexpr Shape bus{bus_fields};
constexpr Field recording_fields[] = {{"active", flag}};
constexpr Shape recording{recording_fields};
constexpr Field real_time_fields[] = {{"degraded", flag}};
constexpr Shape real_time{real_time_fields};

constexpr Field status_fields[] = {{"version", text},
                                   {"rig", text},
                                   {"simulated", flag},
                                   {"state", text, nullptr, true},
                                   {"result", text, nullptr, true},
                                   {"sequence", object | null, &run, true},
                                   {"fault", object | null, &fault, true},
                                   {"channels", list, &channel, true},
                                   {"under_pressure", object | null, &pressure},
                                   {"bus", object, &bus},
                                   {"recording", object, &recording},
                                   {"real_time", object | null, &real_time}};
constexpr Shape status{status_fields};
/// Shape of a result that is a status for some requests and another object for others, so no field is
/// required.
constexpr Shape partial_status{status_fields, false};

constexpr Field parameter_fields[] = {{"name", text},    {"unit", text},      {"lower", number},
                                      {"upper", number}, {"default", number}, {"about", text}};
constexpr Shape parameter{parameter_fields};
constexpr Field sequence_fields[] = {
    {"name", text}, {"about", text}, {"parameters", list, &parameter}, {"problems", list, &problem}};
constexpr Shape sequence{sequence_fields};

constexpr Field result_fields[] = {{"request", count},
                                   {"newest", count},
                                   {"capabilities", list},
                                   {"events", list, &event},
                                   {"sequences", list, &sequence},
                                   {"warnings", list, &problem}};
constexpr Shape result{result_fields};

constexpr Field reply_fields[] = {{"id", count | null},
                                  {"ok", flag, nullptr, true},
                                  {"result", object, &result},
                                  {"error", object, &error}};
constexpr Shape reply{reply_fields};
constexpr Field accepted_fields[] = {{"result", object, &partial_status, true}};
constexpr Shape accepted{accepted_fields};
constexpr Field error_reply_fields[] = {{"error", object, &error, true}};
constexpr Shape error_reply{error_reply_fields};
constexpr Field watch_fields[] = {{"watch", object, &status, true}};
constexpr Shape watch_line{watch_fields};
constexpr Field event_line_fields[] = {{"event", object, &event, true}};
constexpr Shape event_line{event_line_fields};

unsigned kinds_of(const Json& value) {
  if (value.is_string()) return text;
  if (value.is_number_unsigned()) return number | count;
  if (value.is_number()) return number;
  if (value.is_boolean()) return flag;
  if (value.is_object()) return object;
  if (value.is_array()) return list;
  return null;
}

using Fault = std::optional<std::string>;

Fault fault_of(const Json& value, const Shape& shape, const std::string& path);

Fault fault_of_field(const Json& owner, const Field& field, bool is_required, const std::string& path) {
  const auto found = owner.find(field.key);
  if (found == owner.end()) return is_required ? Fault("`" + path + "` is missing") : std::nullopt;
  if ((kinds_of(*found) & field.kinds) == 0) return "`" + path + "` has the wrong type";
  if (field.inside == nullptr) return std::nullopt;
  if (found->is_object()) return fault_of(*found, *field.inside, path);
  if (!found->is_array()) return std::nullopt;
  for (std::size_t i = 0; i < found->size(); ++i) {
    const std::string place = path + "[" + std::to_string(i) + "]";
    if (!(*found)[i].is_object()) return "`" + place + "` has the wrong type";
    if (Fault wrong = fault_of((*found)[i], *field.inside, place)) return wrong;
  }
  return std::nullopt;
}

/// Checks the fields of an object against a shape. `value` must be an object.
Fault fault_of(const Json& value, const Shape& shape, const std::string& path) {
  for (const Field& field : shape.fields) {
    const std::string place = path.empty() ? field.key : path + "." + field.key;
    if (Fault wrong = fault_of_field(value, field, field.is_required && shape.is_whole, place)) return wrong;
  }
  return std::nullopt;
}

Fault fault_of_line(const Json& line) {
  if (line.contains("watch")) return fault_of(line, watch_line, "");
  if (line.contains("event")) return fault_of(line, event_line, "");
  if (Fault wrong = fault_of(line, reply, "")) return wrong;
  return fault_of(line, line["ok"].get<bool>() ? accepted : error_reply, "");
}

bool nests_too_deep(std::string_view line) {
  std::size_t depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char byte = line[i];
    if (in_text && byte == '\\')
      ++i;  // skips the character after a backslash, because an escaped quote does
            // not end the text
    if (byte == '"') in_text = !in_text;
    if (in_text) continue;
    if (byte == '[' || byte == '{') ++depth;
    if ((byte == ']' || byte == '}') && depth > 0) --depth;
    if (depth > max_depth) return true;
  }
  return false;
}

}  // namespace reply_shape
}  // namespace

tl::expected<Json, std::string> parse_reply(std::string_view line) {
  // The nesting depth is checked before parsing, because copying and printing JSON use stack for each level.
  if (reply_shape::nests_too_deep(line)) {
    return tl::unexpected("a line nests deeper than " + std::to_string(reply_shape::max_depth) + " levels");
  }
  Json json = Json::parse(line, nullptr, false);
  if (json.is_discarded()) return tl::unexpected<std::string>("a line is not JSON in UTF-8");
  if (!json.is_object()) return tl::unexpected<std::string>("a line is not a JSON object");
  if (auto wrong = reply_shape::fault_of_line(json)) return tl::unexpected(std::move(*wrong));
  return json;
}

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
