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

}  // namespace

std::string message_of(std::string_view kind, const Json& data) {
  // The JSON text contains no line breaks, so it fits into one data line of the message.
  return "event: " + std::string(kind) +
         "\ndata: " + data.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n\n";
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

}  // namespace softgrip::web
