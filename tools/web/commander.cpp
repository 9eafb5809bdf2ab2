#include "tools/web/commander.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace softgrip::web {

namespace {

using Json = nlohmann::ordered_json;

/// Longest wait for the response to a command. A start may need one second for planning, and additional time
/// for the disk.
constexpr Nanoseconds response_timeout = 8 * ns_per_s;
/// Shortest time between two stop requests for the abandoned starts (AbandonedStart).
constexpr Nanoseconds stop_retry_period = ns_per_s / 4;
constexpr std::size_t longest_sequence_name = 128;
constexpr std::size_t most_parameters = 32;

Json failure(std::string_view code, std::string_view message) {
  return {{"ok", false}, {"error", {{"code", code}, {"message", message}}}};
}

bool are_parameters(const Json& value) {
  return value.is_object() && value.size() <= most_parameters &&
         std::all_of(value.begin(), value.end(), [](const Json& number) { return number.is_number(); });
}

/// Returns "" if the body of a start request is valid, otherwise an error message.
std::string check_start(const Json& body) {
  const auto sequence = body.find("sequence");
  if (sequence == body.end() || !sequence->is_string() || sequence->get<std::string>().empty() ||
      sequence->get<std::string>().size() > longest_sequence_name) {
    return "`sequence` must be the name of a sequence";
  }
  const auto parameters = body.find("parameters");
  if (parameters != body.end() && !are_parameters(*parameters))
    return "`parameters` must map names to numbers";
  return {};
}

}  // namespace

tl::expected<Json, std::string> command_in(std::string_view body) {
  const Json json = Json::parse(body, nullptr, false);
  if (!json.is_object()) return tl::unexpected<std::string>{"the body must be a JSON object"};
  const auto command = json.find("command");
  constexpr std::array<std::string_view, 5> commands{"start", "stop", "vent", "release", "acknowledge"};
  if (command == json.end() || !command->is_string() ||
      std::find(commands.begin(), commands.end(), command->get<std::string>()) == commands.end()) {
    return tl::unexpected<std::string>{"`command` must be start, stop, vent, release or acknowledge"};
  }
  const bool starts = *command == "start";
  for (const auto& [key, value] : json.items()) {
    const bool of_start = key == "sequence" || key == "parameters";
    if (key != "command" && !(starts && of_start))
      return tl::unexpected<std::string>{"the body contains an unknown key"};
  }
  if (starts) {
    if (std::string wrong = check_start(json); !wrong.empty()) return tl::unexpected{std::move(wrong)};
  }
  return json;
}

tl::expected<std::uint64_t, Json> Commander::send(Json request, Nanoseconds now) {
  const std::string& command = request["command"].get_ref<const std::string&>();
  const bool is_urgent = command == "stop" || command == "vent";
  const bool is_start = command == "start";
  if (pending_.size() >= (is_urgent ? 2 * max_pending : max_pending))
    return tl::unexpected<Json>{
        failure("busy", "too many commands are still waiting for a response of the daemon")};
  if (is_start && abandoned_.size() >= max_pending)
    return tl::unexpected<Json>{failure("busy", "the daemon has not confirmed the stops of earlier starts")};
  const bool is_new = !daemon_;
  if (auto refusal = connect()) return tl::unexpected{std::move(*refusal)};
  // If the daemon has no free connection, it processes only the first line, and only if this is a stop or a
  // vent.
  if (is_new && !is_urgent) greet();
  PendingCommand pending{now + response_timeout, is_start ? tools::new_start_id() : std::string(),
                         std::nullopt};
  if (is_start) request["start_id"] = pending.start_id;
  const std::uint64_t number = send_numbered(std::move(request));
  if (is_new && is_urgent) greet();
  pending_[number] = std::move(pending);
  return number;
}

/// Connects to the daemon if there is no connection. If connecting fails, returns the error that is sent to
/// the browser in place of a response of the daemon.
std::optional<Json> Commander::connect() {
  if (daemon_) return std::nullopt;
  if (!may_connect_) return failure("not_allowed", "this page is read-only");
  if (const auto refusal = daemon_.connect_now()) return failure("no_daemon", refusal->message);
  return std::nullopt;
}

/// Sends the name of this program. The events of the daemon then contain the name.
void Commander::greet() {
  daemon_.send({{"id", 0}, {"command", "hello"}, {"client", "softgrip-web"}, {"api", 1}});
}

std::uint64_t Commander::send_numbered(Json request) {
  request["id"] = ++last_id_;
  daemon_.send(request);
  return last_id_;
}

std::optional<Json> Commander::take_response(std::uint64_t number, Nanoseconds now) {
  const auto found = pending_.find(number);
  if (found == pending_.end())
    return failure("no_answer", "the daemon sent a response that belongs to no request");
  PendingCommand& pending = found->second;
  if (!pending.response && now > pending.deadline) {
    complete(pending, failure("no_answer", pending.start_id.empty()
                                               ? "the daemon does not respond"
                                               : "the daemon does not respond; after a reconnection, "
                                                 "softgrip-web stops the sequence of this start"));
  }
  std::optional<Json> response = std::move(pending.response);
  if (response) pending_.erase(found);
  return response;
}

bool Commander::is_open_start(std::uint64_t number) const {
  const auto found = pending_.find(number);
  return found != pending_.end() && !found->second.start_id.empty();
}

void Commander::abandon(std::uint64_t number) {
  const auto found = pending_.find(number);
  if (found == pending_.end()) return;
  abandon_start(found->second);
  pending_.erase(found);
}

void Commander::abandon_all() {
  for (auto& [number, pending] : pending_) abandon_start(pending);
  pending_.clear();
}

void Commander::update(Nanoseconds now) {
  if (daemon_ && !daemon_.receive_lines([&](Json& line) { process_line(std::move(line)); }))
    handle_disconnect();
  retry_stops(now);
}

void Commander::process_line(Json line) {
  const auto id = line.find("id");
  const std::uint64_t number = id != line.end() && id->is_number_unsigned() ? id->get<std::uint64_t>() : 0;
  if (const auto found = pending_.find(number); found != pending_.end())
    return complete(found->second, std::move(line));
  const auto stopped =
      std::find_if(abandoned_.begin(), abandoned_.end(),
                   [number](const AbandonedStart& start) { return start.stop == number && number != 0; });
  if (stopped == abandoned_.end()) return;
  stopped->stop = 0;
  // A daemon of an older version does not know `start_id`, so it has also refused the start. There is no
  // start to stop.
  const bool is_older = line.value("error", Json::object()).value("code", "") == "bad_request";
  if (is_older || tools::confirms_stop(line)) abandoned_.erase(stopped);
}

void Commander::complete(PendingCommand& pending, Json response) {
  if (tools::refuses_start(response)) pending.start_id.clear();
  if (!tools::DaemonClient::result_of(response)) abandon_start(pending);
  pending.response = std::move(response);
}

void Commander::abandon_start(PendingCommand& pending) {
  if (pending.start_id.empty()) return;
  abandoned_.push_back({std::exchange(pending.start_id, {}), 0});
  if (daemon_) stop(abandoned_.back());
}

void Commander::stop(AbandonedStart& start) {
  start.stop = send_numbered(tools::stop_request_for(start.start_id));
}

/// Requests to stop two kinds of starts: those that were abandoned while there was no connection, and those
/// whose stop the daemon has not confirmed.
void Commander::retry_stops(Nanoseconds now) {
  const auto is_due = [](const AbandonedStart& start) { return start.stop == 0; };
  if (std::none_of(abandoned_.begin(), abandoned_.end(), is_due)) return;
  if (last_retry_at_ != 0 && now - last_retry_at_ < stop_retry_period) return;
  last_retry_at_ = now;
  const bool is_new = !daemon_;
  if (connect()) return;
  for (AbandonedStart& start : abandoned_) {
    if (is_due(start)) stop(start);
  }
  if (is_new) greet();
}

void Commander::handle_disconnect() {
  for (AbandonedStart& start : abandoned_) start.stop = 0;
  for (auto& [number, pending] : pending_) {
    if (pending.response) continue;
    complete(pending, failure("no_answer", pending.start_id.empty()
                                               ? "the connection to the daemon was lost before the daemon "
                                                 "responded: check if the command was executed"
                                               : "the connection to the daemon was lost before the daemon "
                                                 "responded; softgrip-web stops the sequence of this start"));
  }
}

}  // namespace softgrip::web
