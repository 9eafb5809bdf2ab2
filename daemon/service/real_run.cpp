// Runs the daemon in real time: starts its threads in a fixed order, and ends them in a fixed order.

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <functional>
#include <latch>
#include <mutex>
#include <optional>
#include <string>

#include <fmt/format.h>

#include "base/exit_code.h"
#include "daemon/loop/real_time.h"
#include "daemon/loop/thread.h"
#include "daemon/service/board_lock.h"
#include "daemon/service/daemon.h"
#include "daemon/service/daemon_parts.h"
#include "daemon/service/panel_run.h"
#include "daemon/service/runtime_folder.h"
#include "daemon/service/service_manager.h"
#include "daemon/socket/socket_api.h"
#include "daemon/socket/socket_server.h"

namespace softgrip::daemon {

namespace {

/// Time after the last deadline of a thread at which a thread that has not ended counts as blocked [ns].
constexpr Nanoseconds longest_join = ns_per_s;
/// Time between two checks in which the main thread checks the other threads [ns].
constexpr Nanoseconds look_pause = ns_per_s / 20;
/// Time in addition to the limits of the rig file for which loop and bus may stand still [ns]. After this
/// time, the daemon no longer feeds the service manager's watchdog. The margin ensures that a short overload
/// of the machine does not restart the daemon.
constexpr Nanoseconds heartbeat_patience = ns_per_s / 2;
/// Longest time of one turn of the service thread [ns]. During a turn for one client, the other clients wait.
constexpr Nanoseconds service_patience = 2 * ns_per_s;
/// Longest time from the safe outputs until the recorder and the service thread must have ended [ns].
constexpr Nanoseconds longest_end = 3 * ns_per_s;
/// Time between two turns of the service thread if the daemon has no socket [ns].
constexpr Nanoseconds service_pause = ns_per_s / 50;
/// Time from the start of the threads to the first tick [ns].
constexpr Nanoseconds lead_time = ns_per_s / 100;

class RealRun {
 public:
  RealRun(DaemonParts& parts, Signals& signals)
      : parts_(parts),
        signals_(signals),
        panel_(parts.rig, parts.options, parts.clock, parts.shared, parts.loop_statistics) {}

  Outcome run();

 private:
  bool listen();
  /// Reports the remarks of the lock, and stores a copy of the rig for the safe outputs after a crash.
  void note_and_keep(const BoardLock& lock);
  void forget_if_rested();
  void start_threads();
  void start();
  /// Executes an action and catches its exceptions. If the action throws, reports the exception and ends the
  /// run in order with all threads.
  void guarded(const std::function<void()>& action);
  void prepare(int priority, const char* who, RealTimeReport& report);
  void look_after();
  void stop();
  [[nodiscard]] bool stop_loop_and_bus();
  [[nodiscard]] bool wait_for(const std::function<bool()>& condition, Nanoseconds longest);
  [[noreturn]] void end_without(const char* hangs, ExitCode code);
  void loop_body();
  void bus_body();
  void recorder_body();
  void service_body();
  void note_broken(const std::string& what);
  [[nodiscard]] bool over(Nanoseconds now);
  [[nodiscard]] Nanoseconds longest_bus_call() const;
  [[nodiscard]] Heartbeat make_heartbeat() const;
  [[nodiscard]] std::string status_line();

  DaemonParts& parts_;
  Signals& signals_;
  PanelRun panel_;
  ServiceManager manager_;
  Outcome outcome_;

  RealTimeReport report_;
  RealTimeReport loop_report_;
  RealTimeReport bus_report_;
  std::latch ready_{2};
  std::latch go_{1};
  Nanoseconds start_ = 0;

  std::optional<SocketServer> server_;
  StopFlag stop_recorder_;
  StopFlag stop_service_;
  std::atomic<bool> loop_done_{false};
  std::atomic<bool> bus_done_{false};
  std::atomic<bool> service_done_{false};
  std::atomic<bool> recorder_done_{false};
  Counter service_turns_;
  std::atomic<bool> one_shot_over_{false};
  std::atomic<bool> broken_{false};
  std::mutex broken_mutex_;
  std::string broken_text_;

  Thread loop_;
  Thread bus_;
  Thread recorder_;
  Thread service_;
};

void RealRun::note_broken(const std::string& what) {
  const std::scoped_lock lock(broken_mutex_);
  if (broken_text_.empty()) broken_text_ = what;
  parts_.tell("internal_error", Severity::error, fmt::format("An exception ended a thread: {}.", what));
  broken_.store(true);
}

void RealRun::prepare(int priority, const char* who, RealTimeReport& report) {
  try {
    prepare_thread(parts_.rig.real_time, priority, who, report);
  } catch (const std::exception& error) {
    note_broken(fmt::format("{}: {}", who, error.what()));
  }
  ready_.count_down();
  go_.wait();
}

void RealRun::loop_body() {
  prepare(parts_.rig.real_time.priority, "the loop", loop_report_);
  parts_.loop.run(PeriodicSchedule(start_, parts_.period()));
  loop_done_.store(true);
}

void RealRun::bus_body() {
  // The priority of the bus thread is 1 lower than the priority of the loop, so that a late exchange does not
  // delay a tick.
  const int priority = parts_.rig.real_time.priority;
  prepare(priority > 1 ? priority - 1 : priority, "the bus", bus_report_);
  parts_.bus.run(PeriodicSchedule(start_ + parts_.bus_offset(), parts_.period()),
                 std::chrono::nanoseconds{shutdown_deadline});
  bus_done_.store(true);
}

void RealRun::recorder_body() {
  const std::chrono::duration<double> pause(parts_.rig.recorder.flush_interval_s);
  while (!stop_recorder_.wait(pause)) parts_.recorder.drain();
  parts_.recorder.finish();
  recorder_done_.store(true);
}

void RealRun::service_body() {
  StatusSources sources{.rig = parts_.rig.settings,
                        .provenance = parts_.provenance,
                        .service = parts_.service,
                        .recorder = parts_.recorder,
                        .loop = parts_.loop_statistics,
                        .bus = parts_.bus_statistics,
                        .board = parts_.board_text,
                        .origin = parts_.origin,
                        .real_time = &report_,
                        .gpio = parts_.rig.gpio ? &*parts_.rig.gpio : nullptr,
                        .shared = &parts_.shared};
  SocketApi api(sources, parts_.rig.socket, parts_.loader, parts_.events,
                [this](ClientId client, std::string_view line, bool skippable) {
                  return server_ && server_->send(client, line, skippable);
                });
  if (server_) {
    server_->set_handlers(
        {.on_line = [&](ClientId client,
                        std::string_view line) { api.on_line(client, line, parts_.clock.now()); },
         .on_closed = [&](ClientId client) { api.on_closed(client); },
         .is_urgent = is_urgent,
         .on_opened = [&](ClientId client, Role role) { api.on_opened(client, role); },
         .keeps_connection = [&](ClientId client) { return api.keeps_connection(client); }});
  }
  while (!stop_service_.is_set()) {
    service_turns_.add();
    parts_.service.pump();
    if (parts_.one_shot_run) {
      parts_.one_shot_run->step(parts_.service, parts_.clock.now());
      one_shot_over_.store(parts_.one_shot_run->finished());
    }
    const Nanoseconds now = parts_.clock.now();
    const Nanoseconds next = api.update(now);
    if (server_) {
      server_->poll(now, next);
    } else {
      stop_service_.wait(std::chrono::duration<double>(seconds(service_pause)));
    }
  }
  parts_.service.pump();
  service_done_.store(true);
}

void RealRun::start_threads() {
  const auto broken = [this](const char* who) {
    return [this, who](const std::string& what) { note_broken(fmt::format("{}: {}", who, what)); };
  };
  bus_ = Thread(
      {.name = "softgrip-bus"}, [this] { bus_body(); }, broken("bus thread"));
  loop_ = Thread(
      {.name = "softgrip-loop"}, [this] { loop_body(); }, broken("loop thread"));
  ready_.wait();
  report_.append(loop_report_);
  report_.append(bus_report_);
  panel_.start(report_);
  recorder_ = Thread(
      {.name = "softgrip-record"}, [this] { recorder_body(); }, broken("recorder thread"));
  service_ = Thread(
      {.name = "softgrip-serve"}, [this] { service_body(); }, broken("service thread"));
}

void RealRun::guarded(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    note_broken(error.what());
  }
  if (broken_.load()) outcome_.ending = Ending::broken;
}

void RealRun::start() {
  guarded([this] { start_threads(); });
  guarded([this] {
    if (parts_.options.on_start)
      parts_.options.on_start(startup_report(parts_.rig, *parts_.board, &report_, parts_.options.program));
  });
  if (parts_.rig.real_time.required && report_.degraded()) {
    outcome_.ending = Ending::real_time_refused;
    outcome_.message =
        "the rig file sets `real_time: required`, but a real-time setting could not be verified";
  }
  // If the loop gets a shutdown request before its first tick, it still sends the safe outputs.
  if (outcome_.ending != Ending::asked) parts_.shared.shutdown_requested.store(true);
  start_ = parts_.clock.now() + lead_time;
  go_.count_down();
}

bool RealRun::over(Nanoseconds now) {
  if (broken_.load()) {
    outcome_.ending = Ending::broken;
    return true;
  }
  if (one_shot_over_.load()) return true;
  const auto& duration = parts_.options.duration_s;
  return duration && now - start_ >= nanoseconds(*duration);
}

std::string RealRun::status_line() {
  const LoopStatistics& loop = parts_.loop_statistics;
  return fmt::format("{} Hz, {} overruns, {} failed exchanges", parts_.rig.settings.rate_hz,
                     loop.overruns_took_long.value() + loop.overruns_woken_late.value(),
                     parts_.bus_statistics.failures.value());
}

/// Returns the longest time for which a call of the bus thread may block [ns].
Nanoseconds RealRun::longest_bus_call() const {
  return std::max<Nanoseconds>(parts_.rig.reconnect.connect_deadline.count(),
                               nanoseconds(parts_.rig.loop.exchange_deadline_s));
}

Heartbeat RealRun::make_heartbeat() const {
  const Nanoseconds pause = parts_.period() + heartbeat_patience;
  return Heartbeat({pause, pause + longest_bus_call(), service_patience});
}

void RealRun::look_after() {
  Heartbeat heartbeat = make_heartbeat();
  Nanoseconds status_due = 0;
  while (signals_.wait(look_pause) == 0) {
    const Nanoseconds now = parts_.clock.now();
    parts_.deliver_events();
    if (over(now)) return;
    manager_.feed(now, heartbeat.beats(now, {parts_.loop_statistics.ticks.value(),
                                             parts_.bus_statistics.steps.value(), service_turns_.value()}));
    if (now >= status_due) {
      manager_.status(status_line());
      status_due = now + ns_per_s;
    }
  }
}

/// Ends the process at once. An orderly end is not possible, because the main thread cannot wait for a
/// blocked thread.
void RealRun::end_without(const char* hangs, ExitCode code) {
  parts_.tell(
      "internal_error", Severity::error,
      fmt::format("{}; the process ends without waiting for this thread. The board {} the safe outputs.",
                  hangs, parts_.shared.safe_state_confirmed.load() ? "confirmed" : "did NOT confirm"));
  guarded([this] {
    parts_.deliver_events();
    if (parts_.options.before_sudden_end) parts_.options.before_sudden_end();
  });
  std::_Exit(static_cast<int>(code));
}

bool RealRun::wait_for(const std::function<bool()>& condition, Nanoseconds longest) {
  const Nanoseconds give_up = parts_.clock.now() + longest;
  while (!condition() && parts_.clock.now() < give_up) {
    // If this run ends because a thread hangs, the output must contain the events until then.
    if (!broken_.load()) guarded([this] { parts_.deliver_events(); });
    parts_.clock.sleep_until(parts_.clock.now() + ns_per_s / 1000);
  }
  return condition();
}

bool RealRun::stop_loop_and_bus() {
  parts_.shared.shutdown_requested.store(true);
  return wait_for([this] { return loop_done_.load() && bus_done_.load(); },
                  shutdown_deadline + longest_join + longest_bus_call());
}

void RealRun::stop() {
  parts_.tell("daemon_stopping", Severity::information, "Stopping: the safe outputs are written.");
  manager_.stopping();
  if (!stop_loop_and_bus())
    end_without("The thread of the control loop or of the bus hangs", ExitCode::failed);
  panel_.stop();
  stop_recorder_.set();
  stop_service_.set();
  const bool done = wait_for([this] { return recorder_done_.load() && service_done_.load(); }, longest_end);
  if (!done) {
    end_without(
        recorder_done_.load() ? "The thread that serves clients hangs" : "The thread of the recorder hangs",
        ExitCode::io);
  }
  recorder_.join();
  service_.join();
  loop_.join();
  bus_.join();
}

bool RealRun::listen() {
  if (!parts_.options.listen || parts_.rig.socket.path.empty()) return true;
  auto server = SocketServer::listen(parts_.rig.socket);
  if (!server) {
    outcome_.ending = Ending::socket_failed;
    outcome_.message = server.error();
    return false;
  }
  server_.emplace(std::move(*server));
  return true;
}

void RealRun::note_and_keep(const BoardLock& lock) {
  for (const std::string& remark : lock.remarks()) parts_.tell("board_lock", Severity::warning, remark + ".");
  const auto kept = keep_rig(parts_.rig);
  if (kept) return;
  parts_.tell("rig_not_kept", Severity::warning,
              fmt::format("{}. After a crash, the safe outputs are read from the rig file, even if the file "
                          "has changed since the start.",
                          kept.error()));
}

/// Removes the stored copy of the rig file if all outputs are at rest. While a finger may be pressurised, the
/// copy is kept, because it contains the safe outputs of this run.
void RealRun::forget_if_rested() {
  if (outcome_.safe_state_confirmed && outcome_.left_on.empty()) forget_rig(parts_.rig.path);
}

Outcome RealRun::run() {
  const ProcessorLatencyRequest latency = prepare_process(parts_.rig.real_time, report_);
  const auto lock = BoardLock::take(parts_.rig);
  if (!lock) {
    outcome_.ending = Ending::board_taken;
    outcome_.message = lock.error();
    return outcome_;
  }
  if (!panel_.open(outcome_) || !listen()) return outcome_;
  note_and_keep(*lock);
  parts_.bus.open();
  start();
  if (outcome_.ending == Ending::asked) {
    parts_.tell("daemon_started", Severity::information, "Control loop started.");
    manager_.ready(status_line());
    guarded([this] { look_after(); });
  }
  stop();
  parts_.conclude(outcome_);
  forget_if_rested();
  if (outcome_.ending == Ending::broken) outcome_.message = broken_text_;
  outcome_.wall_s = seconds(parts_.clock.now() - start_);
  guarded([this] { parts_.deliver_events(); });
  return outcome_;
}

}  // namespace

Outcome run_in_real_time(DaemonParts& parts, Signals& signals) {
  return RealRun(parts, signals).run();
}

}  // namespace softgrip::daemon
