#include "tools/web/live_state.h"

#include <utility>

#include "base/json.h"

namespace softgrip::web {
namespace {

using Json = nlohmann::ordered_json;

/// Largest size of the messages that wait for take_messages() [bytes]. At this size, new messages are
/// dropped.
constexpr std::size_t max_messages_size = std::size_t{1} << 20U;

Json list_of(const std::deque<Json>& items) {
  Json list = Json::array();
  for (const Json& item : items) list.push_back(item);
  return list;
}

using Json = nlohmann::ordered_json;

constexpr double watch_rate_hz = 5;
/// Longest time between two status lines of a daemon. After this time without a status line, the daemon
/// counts as disconnected and the connection is opened again.
constexpr Nanoseconds status_timeout = 3 * ns_per_s / 2;
constexpr Nanoseconds statistics_period = 2 * ns_per_s;
constexpr Nanoseconds sequences_period = 10 * ns_per_s;

/// Ids of the requests to the daemon, one per kind of request.
enum RequestId : std::uint64_t { hello = 1, watch, subscribe, statistics, sequences };

}  // namespace

std::string message_of(std::string_view kind, const Json& data) {
  // The JSON text contains no line breaks, so it fits into one data line of the message.
  return "event: " + std::string(kind) + "\ndata: " + json_dump(data) + "\n\n";
}

void LiveState::set_status(Json status) {
  // If the time is smaller than in the last status, the daemon has restarted, so the old trend is removed.
  if (json_number(status, "time_s") < json_number(status_, "time_s")) trend_.clear();
  status_ = std::move(status);
  append_to_trend();
  if (messages_.size() < max_messages_size) messages_ += message_of("state", status_);
}

void LiveState::append_to_trend() {
  const double now_s = json_number(status_, "time_s");
  Json sample = Json::array({now_s});
  for (const Json& channel : json_member(status_, "channels")) {
    sample.push_back({json_member(channel, "command_kpa"), json_member(channel, "pressure_kpa"),
                      json_member(channel, "displacement_mm"), json_member(channel, "reference_mm")});
  }
  trend_.push_back(std::move(sample));
  while (trend_.front()[0].is_number() && trend_.front()[0].get<double>() < now_s - trend_s)
    trend_.pop_front();
}

void LiveState::add_event(Json event) {
  if (messages_.size() < max_messages_size) messages_ += message_of("happened", event);
  events_.push_back(std::move(event));
  if (events_.size() > events_kept) events_.pop_front();
}

void LiveState::set_statistics(Json statistics) {
  statistics_ = std::move(statistics);
  if (messages_.size() < max_messages_size) messages_ += message_of("statistics", statistics_);
}

void LiveState::set_sequences(Json sequences) {
  if (sequences == sequences_) return;
  sequences_ = std::move(sequences);
  if (messages_.size() < max_messages_size) messages_ += message_of("sequences", sequences_);
}

void LiveState::clear_live_data() {
  if (status_.is_null()) return;
  status_ = nullptr;
  statistics_ = nullptr;
  trend_.clear();
  messages_ += message_of("state", status_);
}

std::string LiveState::snapshot_message() const {
  return message_of("hello", {{"status", status_},
                              {"statistics", statistics_},
                              {"sequences", sequences_},
                              {"events", list_of(events_)},
                              {"trend", list_of(trend_)}});
}

std::string LiveState::take_messages() {
  return std::exchange(messages_, {});
}

void DaemonWatch::update(Nanoseconds now) {
  if (daemon_.connect(now)) send_initial_requests(now);
  const bool connected = daemon_.receive_lines([&](Json& line) { process_line(std::move(line), now); });
  if (connected && now - last_status_at_ > status_timeout) daemon_.disconnect();
  if (daemon_) {
    send_due_requests(now);
  } else {
    state_.clear_live_data();
  }
}

void DaemonWatch::send_initial_requests(Nanoseconds now) {
  last_status_at_ = now;
  statistics_due_ = sequences_due_ = now;
  daemon_.send({{"id", RequestId::hello}, {"command", "hello"}, {"client", "softgrip-web"}, {"api", 1}});
  daemon_.send({{"id", RequestId::watch}, {"command", "watch"}, {"rate_hz", watch_rate_hz}});
  Json request{{"id", RequestId::subscribe}, {"command", "subscribe"}, {"since", last_event_}};
  if (!started_at_.empty()) request["started_at"] = started_at_;
  daemon_.send(request);
}

void DaemonWatch::send_due_requests(Nanoseconds now) {
  if (now >= statistics_due_) {
    statistics_due_ = now + statistics_period;
    daemon_.send({{"id", RequestId::statistics}, {"command", "statistics"}});
  }
  if (now >= sequences_due_) {
    sequences_due_ = now + sequences_period;
    daemon_.send({{"id", RequestId::sequences}, {"command", "sequences"}});
  }
}

void DaemonWatch::process_line(Json line, Nanoseconds now) {
  if (line.contains("watch")) {
    last_status_at_ = now;
    state_.set_status(std::move(line["watch"]));
  } else if (line.contains("event")) {
    last_event_ = static_cast<std::uint64_t>(json_number(line["event"], "id"));
    state_.add_event(std::move(line["event"]));
  } else if (line.value("ok", false) && json_member(line, "id").is_number_unsigned()) {
    process_result(line["id"].get<std::uint64_t>(), std::move(line["result"]));
  }
}

void DaemonWatch::process_result(std::uint64_t id, Json result) {
  if (id == RequestId::subscribe) {
    started_at_ = json_text(result, "started_at");
  } else if (id == RequestId::statistics) {
    state_.set_statistics(std::move(result));
  } else if (id == RequestId::sequences) {
    state_.set_sequences(std::move(result["sequences"]));
  }
}

}  // namespace softgrip::web
