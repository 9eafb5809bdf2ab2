#include "tools/web/daemon_watch.h"

#include <string>
#include <utility>

#include "base/json.h"

namespace softgrip::web {

namespace {

using Json = nlohmann::ordered_json;

constexpr double watch_rate_hz = 5;
/// Longest time between two lines of a daemon. If no line arrives in this time, the daemon counts as
/// disconnected.
constexpr Nanoseconds longest_silence = 3 * ns_per_s / 2;
constexpr Nanoseconds statistics_period = 2 * ns_per_s;
constexpr Nanoseconds sequences_period = 10 * ns_per_s;

/// Ids of the requests to the daemon, one per kind of request.
enum Asked : std::uint64_t { hello = 1, watch, subscribe, statistics, sequences };

}  // namespace

void DaemonWatch::look_after(Nanoseconds now) {
  if (daemon_.connect(now)) greet(now);
  const bool connected = daemon_.hear([&](Json& line) { take(std::move(line), now); });
  if (connected && now - heard_at_ > longest_silence) daemon_.end();
  if (daemon_) {
    ask_what_is_due(now);
  } else {
    state_.lose();
  }
}

void DaemonWatch::greet(Nanoseconds now) {
  heard_at_ = now;
  statistics_due_ = sequences_due_ = now;
  daemon_.send({{"id", Asked::hello}, {"command", "hello"}, {"client", "softgrip-web"}, {"api", 1}});
  daemon_.send({{"id", Asked::watch}, {"command", "watch"}, {"rate_hz", watch_rate_hz}});
  Json request{{"id", Asked::subscribe}, {"command", "subscribe"}, {"since", last_event_}};
  if (!started_at_.empty()) request["started_at"] = started_at_;
  daemon_.send(request);
}

void DaemonWatch::ask_what_is_due(Nanoseconds now) {
  if (now >= statistics_due_) {
    statistics_due_ = now + statistics_period;
    daemon_.send({{"id", Asked::statistics}, {"command", "statistics"}});
  }
  if (now >= sequences_due_) {
    sequences_due_ = now + sequences_period;
    daemon_.send({{"id", Asked::sequences}, {"command", "sequences"}});
  }
}

void DaemonWatch::take(Json line, Nanoseconds now) {
  if (line.contains("watch")) {
    heard_at_ = now;
    state_.take_status(std::move(line["watch"]));
  } else if (line.contains("event")) {
    last_event_ = static_cast<std::uint64_t>(json_number(line["event"], "id"));
    state_.take_event(std::move(line["event"]));
  } else if (line.value("ok", false) && json_member(line, "id").is_number_unsigned()) {
    take_result(line["id"].get<std::uint64_t>(), std::move(line["result"]));
  }
}

void DaemonWatch::take_result(std::uint64_t id, Json result) {
  if (id == Asked::subscribe) {
    started_at_ = json_text(result, "started_at");
  } else if (id == Asked::statistics) {
    state_.take_statistics(std::move(result));
  } else if (id == Asked::sequences) {
    state_.take_sequences(std::move(result["sequences"]));
  }
}

}  // namespace softgrip::web
