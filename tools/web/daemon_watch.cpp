#include "tools/web/daemon_watch.h"

#include <string>
#include <utility>

#include "base/json.h"

namespace softgrip::web {

namespace {

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
