#include "daemon/socket/service.h"

#include <algorithm>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "base/periodic_schedule.h"
#include "control/elements/grip_result.h"

namespace softgrip::daemon {

using EventKind = control::Event::Kind;

namespace {

/// Largest number of requests for which the name of the requesting client is stored.
constexpr std::size_t max_client_names = 256;

/// Returns the fault to which the reply of an event refers.
control::Fault fault_in(const control::Event& event) {
  control::FaultCode code = control::FaultCode::none;
  if (event.kind == EventKind::fault_acknowledged) code = std::get<control::FaultCode>(event.detail);
  if (event.kind == EventKind::request_refused) code = std::get<control::RequestRefusal>(event.detail).cause;
  return {.code = code, .channel = event.channel};
}

}  // namespace

Service::Service(std::vector<std::string> channel_names, Nanoseconds origin, SharedState& shared,
                 EventLog& log, SequenceStore& sequence_store)
    : channel_names_(std::move(channel_names)),
      origin_(origin),
      shared_(shared),
      events_(shared.events),
      log_(log),
      sequence_store_(sequence_store),
      results_(channel_names_.size()) {}

std::optional<std::uint32_t> Service::submit(control::Request::Kind kind,
                                             std::shared_ptr<const LoadedSequence> sequence,
                                             const std::string& client) {
  control::Request request;
  request.kind = kind;
  request.id = last_request_ + 1;
  request.sequence = sequence ? &sequence->prepared : nullptr;
  if (!push(request, std::move(sequence))) {
    const bool vents = kind == control::Request::Kind::vent;
    if (!vents && kind != control::Request::Kind::stop) return std::nullopt;
    return replies_.try_emplace(vents ? last_vent_ : last_stop_).first->first;
  }
  register_request(request.id, client);
  return request.id;
}

std::optional<std::uint32_t> Service::submit_stop(std::uint32_t start, const std::string& client) {
  if (const auto waiting = pending_stops_.find(start); waiting != pending_stops_.end())
    return waiting->second;
  control::Request request;
  request.kind = control::Request::Kind::stop;
  request.id = last_request_ + 1;
  request.of_start = start;
  if (!shared_.named_stops.push(request)) return std::nullopt;
  pending_stops_[start] = request.id;
  register_request(request.id, client);
  return request.id;
}

void Service::register_request(std::uint32_t request, const std::string& client) {
  last_request_ = request;
  replies_[request] = {};
  store_client_name(request, client);
}

void Service::discard_reply(std::uint32_t request) {
  replies_.erase(request);
  std::erase_if(pending_stops_, [request](const auto& stop) { return stop.second == request; });
}

void Service::store_client_name(std::uint32_t request, const std::string& client) {
  if (!client.empty()) clients_[request] = client;
  // Removes the oldest entry, but not the entry of the running sequence.
  auto oldest = clients_.begin();
  if (oldest != clients_.end() && oldest->first == sequence_request_) ++oldest;
  if (clients_.size() > max_client_names) clients_.erase(oldest);
}

std::string Service::client_of(std::uint32_t request) const {
  const auto found = clients_.find(request);
  return found == clients_.end() ? std::string() : found->second;
}

bool Service::push(const control::Request& request, std::shared_ptr<const LoadedSequence> sequence) {
  switch (request.kind) {
    case control::Request::Kind::vent:
      if (!shared_.vents.push(request)) return false;
      last_vent_ = request.id;
      return true;
    case control::Request::Kind::stop:
      if (!shared_.stops.push(request)) return false;
      last_stop_ = request.id;
      return true;
    default:
      break;
  }
  if (sequence) sequence_store_.put(request.id, std::move(sequence));
  if (shared_.requests.push(request)) return true;
  sequence_store_.drop(request.id);
  return false;
}

void Service::pump() {
  for (BusEvent event; shared_.bus_events.pop(event);) {
    EventEntry entry = describe(event);
    entry.time_s = seconds(event.at - origin_);
    const bool fails = event.kind == BusEvent::Kind::failed || event.kind == BusEvent::Kind::not_connected;
    if (fails) bus_failure_ = {entry.code, entry.text};
    if (event.kind == BusEvent::Kind::recovered) bus_failure_ = {};
    log_.add(std::move(entry));
  }
  for (PanelEvent event; shared_.panel_events.pop(event);) {
    EventEntry entry = describe(event);
    entry.time_s = seconds(event.at - origin_);
    log_.add(std::move(entry));
  }
  for (StampedEvent event; events_.pop(event);) process_event(event);
  const std::uint64_t dropped = shared_.events_dropped.load(std::memory_order_relaxed) + events_.lost();
  if (dropped != events_dropped_) {
    log_.add(
        event_of("events_lost", Severity::warning, seconds(snapshot().at - origin_),
                 fmt::format("{} events were lost, because events occurred faster than they could be stored.",
                             dropped - events_dropped_)));
    events_dropped_ = dropped;
  }
}

void Service::process_event(const StampedEvent& stamped) {
  const control::Event& event = stamped.event;
  if (event.kind == EventKind::sequence_started) {
    sequence_ = sequence_store_.find(event.request);
    sequence_request_ = event.request;
    sequence_store_.start_taken(SequenceStore::Reader::service, event.request);
    std::fill(results_.begin(), results_.end(), control::GripResult::none);
    overall_ = control::GripResult::none;
  }
  // From this event on, the loop no longer uses the sequence, so the sequence can be removed.
  if (event.kind == EventKind::request_refused || event.kind == EventKind::start_checked)
    sequence_store_.drop(event.request);
  if (event.kind == EventKind::sequence_finished) {
    last_finished_ = {event.request, std::get<control::SequenceEnd>(event.detail)};
  }
  const auto reply = replies_.find(event.request);
  if (reply != replies_.end() && reply->second.kind == Reply::Kind::pending) {
    const bool refused = event.kind == EventKind::request_refused;
    reply->second.kind = refused ? Reply::Kind::refused : Reply::Kind::accepted;
    if (refused) reply->second.refusal = std::get<control::RequestRefusal>(event.detail).code;
    reply->second.fault = fault_in(event);
    std::erase_if(pending_stops_, [&event](const auto& stop) { return stop.second == event.request; });
  }
  EventEntry entry = describe(event, channel_names_, sequence_ ? &sequence_->prepared : nullptr);
  entry.time_s = seconds(stamped.at - origin_);
  entry.client = client_of(event.request);
  log_.add(std::move(entry));
  if (event.kind == EventKind::grip_result) update_overall_result(stamped);
}

/// Updates the overall result of the grip when the result of a finger changes.
void Service::update_overall_result(const StampedEvent& stamped) {
  const control::Event& event = stamped.event;
  if (event.channel >= results_.size()) return;
  results_[event.channel] = std::get<control::GripAnswer>(event.detail).result;
  const control::GripResult overall =
      overall_result(results_, sequence_ ? sequence_->prepared.channels : ~0U);
  if (overall == std::exchange(overall_, overall) || overall == control::GripResult::none) return;
  EventEntry entry;
  entry.kind = "overall_result";
  entry.time_s = seconds(stamped.at - origin_);
  entry.code = control::title_of(overall);
  entry.request = sequence_request_;
  entry.client = client_of(sequence_request_);
  entry.text = fmt::format("Result of all fingers: {}.", entry.code);
  log_.add(std::move(entry));
}

Service::Reply Service::take_reply(std::uint32_t request) {
  const auto found = replies_.find(request);
  if (found == replies_.end()) return {};
  const Reply reply = found->second;
  if (reply.kind != Reply::Kind::pending) replies_.erase(found);
  return reply;
}

const Snapshot& Service::snapshot() noexcept {
  shared_.snapshot.fetch();
  return shared_.snapshot.value();
}

}  // namespace softgrip::daemon
