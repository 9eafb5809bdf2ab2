#include "tools/web/commander.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace softgrip::web {

namespace {

using Json = nlohmann::ordered_json;

/// A start may take a second to be planned, and as long as the disk takes.
constexpr Nanoseconds longest_wait = 8 * ns_per_s;
constexpr std::size_t longest_sequence_name = 128;
constexpr std::size_t most_parameters = 32;

Json failure(std::string_view code, std::string_view message) {
  return {{"ok", false}, {"error", {{"code", code}, {"message", message}}}};
}

bool are_parameters(const Json& value) {
  return value.is_object() && value.size() <= most_parameters &&
         std::all_of(value.begin(), value.end(), [](const Json& number) { return number.is_number(); });
}

/// Empty, or what is wrong with it.
std::string check_start(const Json& body) {
  const auto sequence = body.find("sequence");
  if (sequence == body.end() || !sequence->is_string() || sequence->get<std::string>().empty() ||
      sequence->get<std::string>().size() > longest_sequence_name) {
    return "`sequence` is the name of a sequence";
  }
  const auto parameters = body.find("parameters");
  if (parameters != body.end() && !are_parameters(*parameters))
    return "`parameters` are numbers by their names";
  return {};
}

}  // namespace

tl::expected<Json, std::string> command_in(std::string_view body) {
  const Json json = Json::parse(body, nullptr, false);
  if (!json.is_object()) return tl::unexpected<std::string>{"the body is no JSON object"};
  const auto command = json.find("command");
  constexpr std::array<std::string_view, 5> commands{"start", "stop", "vent", "release", "acknowledge"};
  if (command == json.end() || !command->is_string() ||
      std::find(commands.begin(), commands.end(), command->get<std::string>()) == commands.end()) {
    return tl::unexpected<std::string>{"`command` is one of start, stop, vent, release, acknowledge"};
  }
  const bool starts = *command == "start";
  for (const auto& [key, value] : json.items()) {
    const bool of_start = key == "sequence" || key == "parameters";
    if (key != "command" && !(starts && of_start))
      return tl::unexpected<std::string>{"unknown key in the body"};
  }
  if (starts) {
    if (std::string wrong = check_start(json); !wrong.empty()) return tl::unexpected{std::move(wrong)};
  }
  return json;
}

tl::expected<std::uint64_t, Json> Commander::send(Json request, Nanoseconds now) {
  const std::string_view command = request["command"].get_ref<const std::string&>();
  const bool is_urgent = command == "stop" || command == "vent";
  if (waiting_.size() >= (is_urgent ? 2 * most_waiting : most_waiting))
    return tl::unexpected<Json>{failure("busy", "too many commands wait for their answers")};
  if (!daemon_) {
    if (socket_.empty()) return tl::unexpected<Json>{failure("not_allowed", "this page is for looking only")};
    auto daemon = tools::DaemonClient::connect_at_once(socket_);
    if (!daemon) return tl::unexpected<Json>{failure("no_daemon", daemon.error().message)};
    daemon_.emplace(std::move(*daemon));
    daemon_->send({{"id", 0}, {"command", "hello"}, {"client", "softgrip-web"}, {"api", 1}});
  }
  request["id"] = ++last_;
  daemon_->send(request);
  waiting_[last_] = {now + longest_wait, std::nullopt};
  return last_;
}

std::optional<Json> Commander::take_answer(std::uint64_t number, Nanoseconds now) {
  const auto found = waiting_.find(number);
  if (found == waiting_.end()) return failure("no_answer", "nobody waits for that answer");
  std::optional<Json> answer = std::move(found->second.answer);
  if (!answer && now > found->second.give_up) answer = failure("no_answer", "the daemon does not answer");
  if (answer) waiting_.erase(found);
  return answer;
}

void Commander::look_after() {
  while (daemon_) {
    auto line = daemon_->next_line(std::chrono::milliseconds(0));
    if (!line) {
      lose();
    } else if (*line) {
      const auto id = (**line).find("id");
      const auto found =
          waiting_.find(id != (**line).end() && id->is_number_unsigned() ? id->get<std::uint64_t>() : 0);
      if (found != waiting_.end()) found->second.answer = std::move(**line);
    } else {
      break;
    }
  }
}

void Commander::lose() {
  daemon_.reset();
  for (auto& [number, waiting] : waiting_) {
    if (!waiting.answer)
      waiting.answer = failure("no_answer", "the daemon went before it answered: look whether it was done");
  }
}

}  // namespace softgrip::web
