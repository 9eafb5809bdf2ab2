#include "daemon/socket/socket_api.h"

#include <algorithm>
#include <chrono>
#include <future>
#include <thread>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/grid.h"
#include "base/wall_clock.h"

namespace softgrip::daemon {

namespace {

using Json = nlohmann::ordered_json;
using Command = ClientRequest::Command;
using Kind = control::Request::Kind;

/// The loop answers within a tick; after this it is not coming.
constexpr Nanoseconds longest_answer = ns_per_s;
/// How long on_time() may be left alone.
constexpr Nanoseconds longest_pause = ns_per_s / 50;

Json json_of(std::optional<std::uint64_t> id) {
  return id ? Json(*id) : Json(nullptr);
}

Json error_json(std::string_view code, std::string_view message) {
  return {{"code", code}, {"message", message}};
}

Json json_of(const document::Problem& problem) {
  return {{"file", problem.file},           {"line", problem.at.line},    {"column", problem.at.column},
          {"line_text", problem.line_text}, {"message", problem.message}, {"hint", problem.hint}};
}

Json json_of(const std::vector<document::Problem>& problems) {
  Json list = Json::array();
  for (const document::Problem& problem : problems) {
    list.push_back(json_of(problem));
  }
  return list;
}

Json json_of(const control::Parameter& parameter) {
  return {{"name", parameter.name},
          {"unit", parameter.unit},
          {"lower", parameter.lower},
          {"upper", parameter.upper},
          {"default", parameter.default_value},
          {"about", parameter.about}};
}

Json json_of(const std::vector<SequenceLoader::Listed>& sequences) {
  Json list = Json::array();
  for (const SequenceLoader::Listed& listed : sequences) {
    Json parameters = Json::array();
    for (const control::Parameter& parameter : listed.parameters) parameters.push_back(json_of(parameter));
    list.push_back({{"name", listed.name},
                    {"about", listed.about},
                    {"parameters", std::move(parameters)},
                    {"problems", json_of(listed.problems.list())}});
  }
  return list;
}

}  // namespace

SocketApi::SocketApi(StatusSources sources, std::shared_ptr<const SequenceLoader> loader,
                     const EventLog& events, Send send)
    : sources_(sources), loader_(std::move(loader)), events_(events), send_(std::move(send)) {}

SocketApi::~SocketApi() {
  if (planned_) abandon_planned();
}

void SocketApi::on_line(ClientId client, std::string_view line, Nanoseconds now) {
  const auto request = parse_client_request(line);
  if (!request) {
    fail(client, request.error().id, error_json("bad_request", request.error().message));
    return;
  }
  switch (request->command) {
    case Command::status:
      ok(client, request->id, status_json(sources_));
      break;
    case Command::watch:
      watch(client, *request, now);
      break;
    case Command::unwatch:
      watches_.erase(client);
      ok(client, request->id, Json::object());
      break;
    case Command::start:
      start(client, *request, now);
      break;
    case Command::stop:
      refuse_planned();
      ask(client, request->id, Kind::stop, nullptr, now);
      break;
    case Command::vent:
      refuse_planned();
      ask(client, request->id, Kind::vent, nullptr, now);
      break;
    case Command::release:
      refuse_planned();
      ask(client, request->id, Kind::release, nullptr, now);
      break;
    case Command::acknowledge:
      ask(client, request->id, Kind::acknowledge, nullptr, now);
      break;
    case Command::events:
      tell_events(client, *request, now);
      break;
    case Command::statistics:
      ok(client, request->id, statistics_json(sources_, request->histograms));
      break;
    case Command::sequences:
      list_sequences(client, request->id);
      break;
  }
}

void SocketApi::on_closed(ClientId client) {
  watches_.erase(client);
  std::erase_if(asked_, [this, client](const auto& entry) {
    if (entry.second.client != client) return false;
    if (asked_.count(entry.first) == 1) sources_.service.forget(entry.first);
    return true;
  });
  if (planned_ && planned_->client == client) abandon_planned();
  if (listing_)
    std::erase_if(listing_->waiting, [client](const auto& waiting) { return waiting.first == client; });
}

Nanoseconds SocketApi::on_time(Nanoseconds now) {
  take_planned(now);
  take_listing();
  for (auto entry = asked_.begin(); entry != asked_.end();) {
    const std::uint32_t request = entry->first;
    const auto end = asked_.upper_bound(request);
    const Service::Answer said = sources_.service.take_answer(request);
    if (said.kind == Service::Answer::Kind::pending && now < entry->second.give_up) {
      entry = end;
      continue;
    }
    for (auto waiting = entry; waiting != end; ++waiting) answer(waiting->second, request, said);
    if (said.kind == Service::Answer::Kind::pending) sources_.service.forget(request);
    entry = asked_.erase(entry, end);
  }
  Nanoseconds next = now + longest_pause;
  for (auto& [client, watch] : watches_) {
    if (now >= watch.due) {
      send_(client, line_of({{"id", json_of(watch.id)}, {"watch", status_json(sources_)}}), true);
      watch.due = std::max(watch.due + watch.period, now);
    }
    next = std::min(next, watch.due);
  }
  return next;
}

/// Nobody who asks for a vent or a stop waits for a plan, or for a disk.
void SocketApi::start(ClientId client, const ClientRequest& request, Nanoseconds now) {
  take_planned(now);
  if (planned_) {
    fail(client, request.id, error_json("busy", "the sequence of an earlier start is still being loaded"));
    return;
  }
  const std::stop_source stop;
  std::packaged_task<SequenceLoader::Result()> load(
      [loader = loader_, name = request.sequence, text = request.sequence_text,
       parameters = request.parameters, token = stop.get_token()] {
        return text.empty() ? loader->load_named(name, parameters, token)
                            : loader->load_text(name, text, parameters, token);
      });
  planned_ = Planned{client, request.id, load.get_future(), stop};
  std::thread(std::move(load)).detach();
}

/// Nobody who asks for a vent waits for a disk, and a directory that hangs costs one thread, however often it
/// is asked for.
void SocketApi::list_sequences(ClientId client, std::optional<std::uint64_t> id) {
  if (!listing_) {
    std::packaged_task<std::vector<SequenceLoader::Listed>()> read(
        [loader = loader_] { return loader->list(); });
    listing_ = Listing{read.get_future(), {}};
    std::thread(std::move(read)).detach();
  }
  listing_->waiting.emplace_back(client, id);
}

void SocketApi::take_listing() {
  if (!listing_ || listing_->read.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  Listing listing = std::move(*listing_);
  listing_.reset();
  const Json result{{"sequences", json_of(listing.read.get())}};
  for (const auto& [client, id] : listing.waiting) ok(client, id, result);
}

void SocketApi::abandon_planned() noexcept {
  planned_->abandoned = true;
  planned_->stop.request_stop();
}

/// Who stops or vents does not want motion a moment later.
void SocketApi::refuse_planned() {
  if (!planned_ || planned_->abandoned) return;
  abandon_planned();
  fail(planned_->client, planned_->id,
       error_json("abandoned", "a stop or a vent came while the sequence was being loaded"));
}

void SocketApi::take_planned(Nanoseconds now) {
  if (!planned_ || planned_->loaded.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
  Planned planned = std::move(*planned_);
  planned_.reset();
  SequenceLoader::Result sequence = planned.loaded.get();
  // Who left before the motion could begin does not want it any more.
  if (!planned.abandoned) loaded(planned.client, planned.id, std::move(sequence), now);
}

void SocketApi::loaded(ClientId client, std::optional<std::uint64_t> id, SequenceLoader::Result sequence,
                       Nanoseconds now) {
  if (sequence) {
    ask(client, id, Kind::start, std::move(*sequence), now);
    return;
  }
  Json error = error_json("sequence_refused", "the sequence cannot be run on this rig");
  error["problems"] = json_of(sequence.error().list());
  fail(client, id, error);
}

void SocketApi::ask(ClientId client, std::optional<std::uint64_t> id, Kind kind,
                    std::shared_ptr<const LoadedSequence> sequence, Nanoseconds now) {
  document::Problems remarks;
  if (sequence) remarks = sequence->remarks;
  const auto number = sources_.service.submit(kind, std::move(sequence));
  if (!number) {
    fail(client, id, error_json("busy", "the loop has not yet taken the requests before this one"));
    return;
  }
  asked_.insert({*number, {client, id, now + longest_answer, std::move(remarks)}});
}

void SocketApi::answer(const Asked& asked, std::uint32_t request, const Service::Answer& answer) {
  if (answer.kind == Service::Answer::Kind::pending) {
    fail(asked.client, asked.id, error_json("no_answer", "the loop did not answer within a second"));
    return;
  }
  if (answer.kind == Service::Answer::Kind::accepted) {
    Json result{{"request", request}};
    if (answer.fault.code != control::FaultCode::none) {
      result["acknowledged"] = fault_title_json(answer.fault, sources_.service.channel_names());
    }
    if (!asked.remarks.warnings().empty()) result["warnings"] = json_of(asked.remarks.warnings());
    ok(asked.client, asked.id, result);
    return;
  }
  Json error =
      error_json("refused", sentences_of(answer.refusal, answer.fault, sources_.service.channel_names()));
  error["refusal"] = {{"code", control::id_of(answer.refusal)}, {"name", control::name_of(answer.refusal)}};
  error["request"] = request;
  fail(asked.client, asked.id, error);
}

void SocketApi::watch(ClientId client, const ClientRequest& request, Nanoseconds now) {
  const auto period = static_cast<Nanoseconds>(static_cast<double>(ns_per_s) / request.rate_hz);
  watches_[client] = {request.id, period, now};
  ok(client, request.id, {{"rate_hz", request.rate_hz}});
}

void SocketApi::tell_events(ClientId client, const ClientRequest& request, Nanoseconds now) {
  Json list = Json::array();
  const Nanoseconds started = wall_time_now() - (now - sources_.origin);
  for (const EventEntry& event : events_.since(request.since, request.limit)) {
    Json json = event_json(event);
    json["at"] = utc_text(started + nanoseconds(event.time_s), 3);
    list.push_back(std::move(json));
  }
  ok(client, request.id, {{"events", std::move(list)}, {"newest", events_.newest()}});
}

void SocketApi::ok(ClientId client, std::optional<std::uint64_t> id, const Json& result) {
  send_(client, line_of({{"id", json_of(id)}, {"ok", true}, {"result", result}}), false);
}

void SocketApi::fail(ClientId client, std::optional<std::uint64_t> id, const Json& error) {
  send_(client, line_of({{"id", json_of(id)}, {"ok", false}, {"error", error}}), false);
}

std::string error_line(std::optional<std::uint64_t> id, std::string_view code, std::string_view message) {
  return line_of({{"id", json_of(id)}, {"ok", false}, {"error", error_json(code, message)}});
}

}  // namespace softgrip::daemon
