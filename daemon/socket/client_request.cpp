#include "daemon/socket/client_request.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "document/problem.h"

namespace softgrip::daemon {

namespace {

using SortedJson = nlohmann::json;
using Command = ClientRequest::Command;

constexpr std::uint64_t largest_id = std::uint64_t{1} << 53;  // largest id: every JSON reader represents all
                                                              // integers up to 2^53 exactly
constexpr std::uint64_t largest_request = (std::uint64_t{1} << 32) - 1;

constexpr std::array<std::pair<std::string_view, Command>, 14> commands{{
    {"status", Command::status},
    {"watch", Command::watch},
    {"unwatch", Command::unwatch},
    {"start", Command::start},
    {"stop", Command::stop},
    {"vent", Command::vent},
    {"release", Command::release},
    {"acknowledge", Command::acknowledge},
    {"events", Command::events},
    {"statistics", Command::statistics},
    {"sequences", Command::sequences},
    {"hello", Command::hello},
    {"subscribe", Command::subscribe},
    {"unsubscribe", Command::unsubscribe},
}};

/// The only key whose value may be an object.
constexpr std::string_view nested_key = "parameters";
constexpr std::size_t most_parameters = 64;
constexpr std::size_t longest_name = 64;

/// Parses a JSON object. The value of nested_key may be an object; all other values must not be objects. If
/// the line is not such an object, `problem` contains the reason.
SortedJson parse_object(std::string_view line, std::string& problem) {
  std::array<std::vector<std::string>, 2> keys;  // keys of the outer object ([0]) and of the nested object
                                                 // ([1])
  const auto callback = [&](int depth, SortedJson::parse_event_t event, SortedJson& parsed) {
    const bool object = event == SortedJson::parse_event_t::object_start;
    const bool nested = object || event == SortedJson::parse_event_t::array_start;
    const bool expected = object && depth == 1 && !keys[0].empty() && keys[0].back() == nested_key;
    if (nested && depth > 0 && !expected) problem = "a request must be one flat JSON object";
    if (event == SortedJson::parse_event_t::key && (depth == 1 || depth == 2)) {
      std::vector<std::string>& seen = keys[depth == 1 ? 0 : 1];
      const auto key = parsed.get<std::string>();
      if (std::find(seen.begin(), seen.end(), key) != seen.end())
        problem = "the key '" + key + "' appears twice";
      seen.push_back(key);
    }
    return problem.empty();
  };
  SortedJson object = SortedJson::parse(line.begin(), line.end(), callback, false);
  if (problem.empty() && !object.is_object()) problem = "not a JSON object";
  return object;
}

/// Reads the keys of an object and removes each key that was read. The keys that remain are unknown.
class Reader {
 public:
  explicit Reader(SortedJson& object) : object_(object) {}

  template <class Whole>
  void whole(const char* key, std::uint64_t lower, std::uint64_t upper, Whole& value) {
    const SortedJson given = take(key);
    if (given.is_null()) return;
    if (!given.is_number_unsigned() || given.get<std::uint64_t>() < lower ||
        given.get<std::uint64_t>() > upper) {
      fail(fmt::format("'{}' must be a whole number from {} to {}", key, lower, upper));
      return;
    }
    value = given.get<std::uint64_t>();
  }
  void number(const char* key, double lower, double upper, double& value) {
    const SortedJson given = take(key);
    if (given.is_null()) return;
    if (!given.is_number() || !(given.get<double>() >= lower) || !(given.get<double>() <= upper)) {
      fail(fmt::format("'{}' must be a number from {} to {}", key, lower, upper));
      return;
    }
    value = given.get<double>();
  }
  void text(const char* key, std::string& value) {
    const SortedJson given = take(key);
    if (given.is_null()) return;
    if (!given.is_string() || given.get_ref<const std::string&>().empty()) {
      fail(fmt::format("'{}' must be a text that is not empty", key));
      return;
    }
    value = given.get<std::string>();
  }
  /// Reads a name. Control characters are an error, because the name appears in events and logs.
  void name(const char* key, std::string& value) {
    text(key, value);
    const bool printable = document::shown(value, value.size()) == value;
    if (value.size() > longest_name || !printable) {
      fail(fmt::format("'{}' must have at most {} bytes and no control characters", key, longest_name));
    }
  }
  void boolean(const char* key, bool& value) {
    const SortedJson given = take(key);
    if (given.is_null()) return;
    if (!given.is_boolean()) {
      fail(fmt::format("'{}' must be true or false", key));
      return;
    }
    value = given.get<bool>();
  }
  void parameters(const char* key, std::vector<control::Argument>& values) {
    const SortedJson given = take(key);
    if (given.is_null()) return;
    if (!given.is_object() || given.size() > most_parameters) {
      fail(fmt::format("'{}' must be an object of at most {} numbers", key, most_parameters));
      return;
    }
    for (const auto& [name, value] : given.items()) {
      if (value.is_number()) {
        values.push_back({name, value.get<double>()});
      } else {
        fail(fmt::format("the parameter '{}' must be a number", name));
      }
    }
  }
  void fail(std::string problem) {
    if (problem_.empty()) problem_ = std::move(problem);
  }
  /// Returns the first problem of the object; empty if there is none. An unknown key is also a problem.
  [[nodiscard]] std::string finish(std::string_view command) {
    for (const auto& [key, value] : object_.items()) {
      fail(fmt::format("the command '{}' has no key '{}'", command, key));
    }
    return problem_;
  }

 private:
  /// Removes a key and returns its value. If the key is absent, returns null. If the key is present with the
  /// value null, reports an error.
  SortedJson take(const char* key) {
    const auto found = object_.find(key);
    if (found == object_.end()) return nullptr;
    SortedJson value = std::move(*found);
    object_.erase(found);
    if (value.is_null()) fail(fmt::format("'{}' is null", key));
    return value;
  }

  SortedJson& object_;
  std::string problem_;
};

void read_arguments(Reader& reader, ClientRequest& request) {
  switch (request.command) {
    case Command::watch:
      reader.number("rate_hz", 0.1, 50, request.rate_hz);
      break;
    case Command::start:
      reader.text("sequence", request.sequence);
      reader.text("sequence_text", request.sequence_text);
      reader.parameters("parameters", request.parameters);
      reader.boolean("dry_run", request.dry_run);
      reader.name("start_id", request.start_id);
      if (request.sequence.empty()) reader.fail("'start' needs the key 'sequence'");
      if (request.dry_run && !request.start_id.empty())
        reader.fail("'start_id' is not allowed in a dry run, because a dry run starts nothing");
      break;
    case Command::stop:
      reader.whole("request", 1, largest_request, request.request);
      reader.name("start_id", request.start_id);
      if (request.request && !request.start_id.empty())
        reader.fail("'stop' takes 'request' or 'start_id', not both");
      break;
    case Command::events:
      reader.whole("since", 0, largest_id, request.since);
      reader.whole("limit", 1, 1000, request.limit);
      break;
    case Command::subscribe:
      reader.whole("since", 0, largest_id, request.since);
      reader.text("started_at", request.started_at);
      break;
    case Command::hello:
      reader.name("client", request.client);
      reader.whole("api", 1, largest_id, request.api);
      break;
    case Command::statistics:
      reader.boolean("histograms", request.histograms);
      break;
    case Command::status:
    case Command::unwatch:
    case Command::vent:
    case Command::release:
    case Command::acknowledge:
    case Command::sequences:
    case Command::unsubscribe:
      break;
  }
}

}  // namespace

tl::expected<ClientRequest, ClientError> parse_client_request(std::string_view line) {
  std::string problem;
  SortedJson object = parse_object(line, problem);
  if (!problem.empty()) return tl::unexpected(ClientError{std::nullopt, problem});

  ClientRequest request;
  Reader reader(object);
  reader.whole("id", 0, largest_id, request.id);
  std::string command;
  reader.text("command", command);
  const auto known = std::find_if(commands.begin(), commands.end(),
                                  [&](const auto& entry) { return entry.first == command; });
  if (known != commands.end()) {
    request.command = known->second;
    read_arguments(reader, request);
  } else {
    reader.fail(command.empty() ? "the key 'command' is missing" : fmt::format("no command '{}'", command));
    object.clear();
  }
  problem = reader.finish(command);
  if (!problem.empty()) return tl::unexpected(ClientError{request.id, problem});
  return request;
}

std::vector<std::string_view> commands_of(Role role) {
  std::vector<std::string_view> names;
  for (const auto& [name, command] : commands) {
    if (role == Role::operate || is_read_only(command)) names.push_back(name);
  }
  return names;
}

bool is_read_only(Command command) noexcept {
  switch (command) {
    case Command::start:
    case Command::stop:
    case Command::vent:
    case Command::release:
    case Command::acknowledge:
      return false;
    default:
      return true;
  }
}

bool is_urgent(std::string_view line) {
  const auto request = parse_client_request(line);
  return request && (request->command == ClientRequest::Command::stop ||
                     request->command == ClientRequest::Command::vent);
}

}  // namespace softgrip::daemon
