#include "daemon/socket/socket_api.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/periodic_schedule.h"
#include "daemon/socket/reply_json.h"

namespace softgrip::daemon {

namespace {

using Json = nlohmann::ordered_json;
using Command = ClientRequest::Command;
using Kind = control::Request::Kind;

/// Longest time to wait for the loop's reply to a request [ns]. The loop normally replies within one tick.
constexpr Nanoseconds reply_timeout = ns_per_s;
/// Longest time between two calls of update() [ns]: update_period in general, and pending_update_period while
/// a client waits for the loop's reply.
constexpr Nanoseconds update_period = ns_per_s / 50;
constexpr Nanoseconds pending_update_period = ns_per_s / 1000;

}  // namespace

SocketApi::SocketApi(StatusSources sources, rig::SocketSettings settings,
                     std::shared_ptr<const SequenceLoader> loader, const EventLog& events, SendLine send)
    : sources_(sources),
      settings_(std::move(settings)),
      started_at_(utc_text(wall_time(sources.origin), 3)),
      loader_(std::move(loader)),
      events_(events, sources.origin, started_at_),
      send_(std::move(send)) {}

SocketApi::~SocketApi() {
  if (loading_) abandon_loading();
}

void SocketApi::on_line(ClientId client, std::string_view line, Nanoseconds now) {
  const auto request = parse_client_request(line);
  if (!request)
    return send_error(client, request.error().id, error_json("bad_request", request.error().message));
  if (const Json refusal = refusal_of(client, *request); !refusal.is_null())
    return send_error(client, request->id, refusal);
  switch (request->command) {
    case Command::hello:
      process_hello(client, *request);
      break;
    case Command::subscribe:
      send_result(client, request->id, events_.subscribe(client, *request));
      break;
    case Command::unsubscribe:
      events_.unsubscribe(client);
      send_result(client, request->id, Json::object());
      break;
    case Command::status:
      send_result(client, request->id, status());
      break;
    case Command::watch:
      watch(client, *request, now);
      break;
    case Command::unwatch:
      watches_.erase(client);
      send_result(client, request->id, Json::object());
      break;
    case Command::start:
      start(client, *request, now);
      break;
    case Command::stop:
      stop(client, *request, now);
      break;
    case Command::vent:
      refuse_loading();
      submit(client, request->id, Kind::vent, nullptr, now);
      break;
    case Command::release:
      refuse_loading();
      submit(client, request->id, Kind::release, nullptr, now);
      break;
    case Command::acknowledge:
      submit(client, request->id, Kind::acknowledge, nullptr, now);
      break;
    case Command::events:
      send_result(client, request->id, events_.list(*request, now));
      break;
    case Command::statistics:
      send_result(client, request->id,
                  statistics_json(sources_, events_.log().counts(), request->histograms));
      break;
    case Command::sequences:
      list_sequences(client, request->id);
      break;
  }
}

/// Returns the reason why this client may not make the request at present; null if the request is allowed.
/// The check of a start (dry run) has the same rule as a start.
Json SocketApi::refusal_of(ClientId client, const ClientRequest& request) const {
  if (is_read_only(request.command)) return nullptr;
  const auto found = clients_.find(client);
  if (found == clients_.end() || found->second.role != Role::operate) {
    return error_json("not_allowed",
                      "this socket is read-only; connect to `socket: path` of the rig to move the gripper");
  }
  const bool is_stop_or_vent = request.command == Command::stop || request.command == Command::vent;
  const std::string* const other = owner();
  if (is_stop_or_vent || request.dry_run || other == nullptr || owner_client() == client) return nullptr;
  Json error = error_json("owned", "'" + *other +
                                       "' has started the running sequence and is still connected: other "
                                       "clients may only stop and vent");
  error["owner"] = *other;
  return error;
}

/// Returns the name of the client whose sequence runs or is requested; nullptr if there is no such client. If
/// this client has no name or has disconnected, also returns nullptr.
const std::string* SocketApi::owner() const {
  const auto found = clients_.find(owner_client());
  return found == clients_.end() || found->second.name.empty() ? nullptr : &found->second.name;
}

/// Returns the client whose sequence runs. If no sequence runs, returns the client of the first start to
/// which the loop has not replied yet; 0 if there is no such start. The returned client may have
/// disconnected.
ClientId SocketApi::owner_client() const {
  const std::uint32_t running = sources_.service.sequence_request();
  if (sources_.service.is_running(running)) return starts_.client_of(running);
  const auto waiting =
      std::ranges::find_if(pending_requests_, [this](const auto& entry) { return starts_.has(entry.first); });
  return waiting == pending_requests_.end() ? 0 : waiting->second.client;
}

bool SocketApi::keeps_connection(ClientId client) const {
  if (events_.has(client)) return true;
  if (loading_ && loading_->client == client && !loading_->abandoned) return true;
  return owner_client() == client;
}

Json SocketApi::status() const {
  Json json = status_json(sources_);
  const std::string* const name = owner();
  json["owner"] = name != nullptr ? Json(*name) : Json(nullptr);
  return json;
}

void SocketApi::process_hello(ClientId client, const ClientRequest& request) {
  if (request.api != api_version) {
    send_error(
        client, request.id,
        error_json("wrong_api", "this daemon supports only protocol version " + std::to_string(api_version)));
    return;
  }
  Client& known = clients_[client];
  if (!request.client.empty()) known.name = request.client;
  send_result(client, request.id,
              hello_json({.software_version = sources_.provenance.software_version,
                          .started_at = started_at_,
                          .role = known.role,
                          .client = known.name,
                          .reply_timeout_s = seconds(reply_timeout)},
                         settings_));
}

void SocketApi::on_opened(ClientId client, Role role) {
  clients_[client] = {role, {}};
}

void SocketApi::on_closed(ClientId client) {
  clients_.erase(client);
  events_.unsubscribe(client);
  watches_.erase(client);
  std::erase_if(pending_requests_, [this, client](const auto& entry) {
    if (entry.second.client != client) return false;
    if (pending_requests_.count(entry.first) == 1) sources_.service.discard_reply(entry.first);
    return true;
  });
  if (loading_ && loading_->client == client) abandon_loading();
  if (listing_)
    std::erase_if(listing_->waiting, [client](const auto& waiting) { return waiting.first == client; });
}

Nanoseconds SocketApi::update(Nanoseconds now) {
  process_loaded(now);
  process_listing();
  for (auto entry = pending_requests_.begin(); entry != pending_requests_.end();) {
    const std::uint32_t request = entry->first;
    const auto end = pending_requests_.upper_bound(request);
    const Service::Reply reply = sources_.service.take_reply(request);
    if (reply.kind == Service::Reply::Kind::pending && now < entry->second.deadline) {
      entry = end;
      continue;
    }
    for (auto waiting = entry; waiting != end; ++waiting) send_reply(waiting->second, request, reply);
    if (reply.kind == Service::Reply::Kind::pending) sources_.service.discard_reply(request);
    entry = pending_requests_.erase(entry, end);
  }
  events_.send_new_events(now, send_);
  Nanoseconds next = now + (pending_requests_.empty() ? update_period : pending_update_period);
  for (auto& [client, watch] : watches_) {
    if (now >= watch.due) {
      send_(client, line_of({{"id", id_json(watch.id)}, {"watch", status()}}), true);
      watch.due = std::max(watch.due + watch.period, now);
    }
    next = std::min(next, watch.due);
  }
  return next;
}

/// Loads the sequence of a start in a separate thread, so that a vent or stop request never waits for the
/// planning or for the disk.
void SocketApi::start(ClientId client, const ClientRequest& request, Nanoseconds now) {
  process_loaded(now);
  if (loading_) {
    send_error(client, request.id,
               error_json("busy", "the sequence of an earlier start is still being loaded"));
    return;
  }
  if (const Json refusal = refusal_of_id(request.start_id); !refusal.is_null())
    return send_error(client, request.id, refusal);
  const std::stop_source stop;
  std::packaged_task<SequenceLoader::Result()> load(
      [loader = loader_, name = request.sequence, text = request.sequence_text,
       parameters = request.parameters, token = stop.get_token()] {
        return text.empty() ? loader->load_named(name, parameters, token)
                            : loader->load_text(name, text, parameters, token);
      });
  loading_ = LoadingStart{.client = client,
                          .id = request.id,
                          .loaded = load.get_future(),
                          .stop = stop,
                          .start_id = request.start_id,
                          .dry_run = request.dry_run};
  std::thread(std::move(load)).detach();
}

/// Checks the id of a new start. Returns null if the id is allowed, otherwise the error.
Json SocketApi::refusal_of_id(const std::string& start_id) const {
  if (starts_.is_forbidden(start_id))
    return error_json("abandoned", "a stop request for this start arrived before the start request");
  if (starts_.request_of(start_id))
    return error_json("bad_request", "an earlier start already has this 'start_id'");
  return nullptr;
}

void SocketApi::stop(ClientId client, const ClientRequest& request, Nanoseconds now) {
  if (request.request || !request.start_id.empty()) return stop_of(client, request, now);
  refuse_loading();
  submit(client, request.id, Kind::stop, nullptr, now);
}

/// Stops one start in any of four states: not received yet, being loaded, passed to the loop, or running.
void SocketApi::stop_of(ClientId client, const ClientRequest& request, Nanoseconds now) {
  const std::string& id = request.start_id;
  if (!id.empty() && loading_ && !loading_->abandoned && loading_->start_id == id) {
    refuse_loading();
    starts_.forbid(id);
    send_result(client, request.id, {{"request", 0}});
    return;
  }
  std::optional<std::uint32_t> start = starts_.request_of(id);
  if (request.request && starts_.has(static_cast<std::uint32_t>(*request.request)))
    start = static_cast<std::uint32_t>(*request.request);
  if (!start) {
    if (!id.empty()) starts_.forbid(id);
    send_error(client, request.id, refused_json(control::RefusalCode::named_start_not_running, {}, 0));
    return;
  }
  const auto number = sources_.service.submit_stop(*start, clients_[client].name);
  register_pending(number, {.client = client, .id = request.id, .deadline = now + reply_timeout});
}

/// Lists the sequences of the directory. A separate thread reads their files, so that a vent request never
/// waits for the disk. If the directory blocks, only one thread is blocked, even if there are many requests.
void SocketApi::list_sequences(ClientId client, std::optional<std::uint64_t> id) {
  if (!listing_) {
    std::packaged_task<std::vector<SequenceLoader::SequenceInfo>()> read(
        [loader = loader_] { return loader->list(); });
    listing_ = Listing{read.get_future(), {}};
    std::thread(std::move(read)).detach();
  }
  listing_->waiting.emplace_back(client, id);
}

void SocketApi::process_listing() {
  if (!listing_ || listing_->read.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  Listing listing = std::move(*listing_);
  listing_.reset();
  const Json result{{"sequences", sequences_json(listing.read.get())}};
  for (const auto& [client, id] : listing.waiting) send_result(client, id, result);
}

void SocketApi::abandon_loading() noexcept {
  loading_->abandoned = true;
  loading_->stop.request_stop();
}

/// Refuses the start whose sequence is being loaded, because a stop, vent or release request has arrived.
void SocketApi::refuse_loading() {
  if (!loading_ || loading_->abandoned) return;
  abandon_loading();
  send_error(
      loading_->client, loading_->id,
      error_json("abandoned", "a stop, vent or release request arrived while the sequence was being loaded"));
}

void SocketApi::process_loaded(Nanoseconds now) {
  if (!loading_ || loading_->loaded.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  LoadingStart start = std::move(*loading_);
  loading_.reset();
  SequenceLoader::Result sequence = start.loaded.get();
  // If the client has disconnected, or if a stop, vent or release request has arrived, the sequence is not
  // started.
  if (!start.abandoned) start_loaded(start, std::move(sequence), now);
}

void SocketApi::start_loaded(const LoadingStart& start, SequenceLoader::Result sequence, Nanoseconds now) {
  if (!sequence) {
    Json error = error_json("sequence_refused", "the sequence cannot be run on this rig");
    error["problems"] = problems_json(sequence.error().list());
    send_error(start.client, start.id, error);
    return;
  }
  const Kind kind = start.dry_run ? Kind::check : Kind::start;
  const auto number = submit(start.client, start.id, kind, std::move(*sequence), now);
  if (number && !start.dry_run)
    starts_.add({.request = *number, .id = start.start_id, .client = start.client},
                sources_.service.sequence_request());
}

std::optional<std::uint32_t> SocketApi::submit(ClientId client, std::optional<std::uint64_t> id, Kind kind,
                                               std::shared_ptr<const LoadedSequence> sequence,
                                               Nanoseconds now) {
  PendingRequest pending{.client = client, .id = id, .deadline = now + reply_timeout};
  if (sequence) pending.remarks = sequence->remarks;
  if (kind == Kind::check) pending.checked = sequence;
  const auto number = sources_.service.submit(kind, std::move(sequence), clients_[client].name);
  register_pending(number, std::move(pending));
  return number;
}

/// Stores that the client waits for the loop's reply to the request `number`. If `number` is empty, because
/// the loop's queue was full, the client gets the reply `busy`.
void SocketApi::register_pending(std::optional<std::uint32_t> number, PendingRequest pending) {
  if (number) {
    pending_requests_.insert({*number, std::move(pending)});
  } else {
    send_error(pending.client, pending.id,
               error_json("busy", "the control loop has not yet processed the previous requests"));
  }
}

void SocketApi::send_reply(const PendingRequest& pending, std::uint32_t request,
                           const Service::Reply& reply) {
  if (reply.kind == Service::Reply::Kind::pending) {
    send_error(pending.client, pending.id,
               error_json("no_answer", "the control loop did not respond within 1 s"));
    return;
  }
  if (reply.kind == Service::Reply::Kind::accepted) {
    Json result{{"request", request}};
    if (reply.fault.code != control::FaultCode::none) {
      result["acknowledged"] = fault_title_json(reply.fault, sources_.service.channel_names());
    }
    if (pending.checked) result["would_start"] = checked_json(*pending.checked);
    if (!pending.remarks.warnings().empty()) result["warnings"] = problems_json(pending.remarks.warnings());
    send_result(pending.client, pending.id, result);
    return;
  }
  send_error(pending.client, pending.id, refused_json(reply.refusal, reply.fault, request));
}

Json SocketApi::refused_json(control::RefusalCode refusal, const control::Fault& fault,
                             std::uint32_t request) const {
  Json error = error_json("refused", sentences_of(refusal, fault, sources_.service.channel_names()));
  error["refusal"] = {{"code", control::id_of(refusal)}, {"name", control::name_of(refusal)}};
  error["request"] = request;
  return error;
}

void SocketApi::watch(ClientId client, const ClientRequest& request, Nanoseconds now) {
  const auto period = static_cast<Nanoseconds>(static_cast<double>(ns_per_s) / request.rate_hz);
  watches_[client] = {.id = request.id, .period = period, .due = now};
  send_result(client, request.id, {{"rate_hz", request.rate_hz}});
}

void SocketApi::send_result(ClientId client, std::optional<std::uint64_t> id, const Json& result) {
  send_(client, line_of({{"id", id_json(id)}, {"ok", true}, {"result", result}}), false);
}

void SocketApi::send_error(ClientId client, std::optional<std::uint64_t> id, const Json& error) {
  send_(client, line_of({{"id", id_json(id)}, {"ok", false}, {"error", error}}), false);
}

}  // namespace softgrip::daemon
