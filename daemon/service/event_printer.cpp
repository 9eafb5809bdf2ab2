#include "daemon/service/event_printer.h"

#include <csignal>
#include <cstdlib>
#include <sstream>

#include <spdlog/async.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace softgrip::daemon {

namespace {

constexpr double window_s = 10;
constexpr int most_per_window = 20;
constexpr std::size_t lines_kept = 4096;

spdlog::level::level_enum level_of(Severity severity) {
  switch (severity) {
    case Severity::information:
      return spdlog::level::info;
    case Severity::warning:
      return spdlog::level::warn;
    case Severity::error:
      return spdlog::level::err;
  }
  return spdlog::level::info;
}

}  // namespace

EventPrinter::EventPrinter(bool beside) {
  auto sink = std::make_shared<spdlog::sinks::stderr_color_sink_mt>();
  if (beside) {
    // The writer's thread takes no signal: one that came to it would end the process without the safe
    // outputs.
    sigset_t all;
    sigset_t before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    writer_ = std::make_shared<spdlog::details::thread_pool>(lines_kept, 1);
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    logger_ = std::make_shared<spdlog::async_logger>("softgripd", sink, writer_,
                                                     spdlog::async_overflow_policy::overrun_oldest);
  } else {
    logger_ = std::make_shared<spdlog::logger>("softgripd", sink);
  }
  // The journal knows the time itself.
  const bool journal = std::getenv("JOURNAL_STREAM") != nullptr;
  logger_->set_pattern(journal ? "%l: %v" : "%H:%M:%S.%e %^%l%$: %v");
  logger_->flush_on(spdlog::level::info);
}

bool EventPrinter::passes(const EventEntry& event) {
  Flow& flow = flows_[event.kind];
  if (event.time_s - flow.window_s > window_s) {
    if (flow.suppressed > 0)
      logger_->warn("{} more events of the kind {} were not printed", flow.suppressed, event.kind);
    flow = {event.time_s, 0, 0};
  }
  if (flow.printed < most_per_window) {
    ++flow.printed;
    return true;
  }
  ++flow.suppressed;
  return false;
}

void EventPrinter::print(const EventEntry& event) {
  if (passes(event)) logger_->log(level_of(event.severity), "[{:.3f} s] {}", event.time_s, event.text);
}

void EventPrinter::print_report(const std::string& report) {
  std::istringstream lines(report);
  for (std::string line; std::getline(lines, line);) logger_->info("{}", line);
}

void EventPrinter::print_end(const Outcome& outcome) {
  if (!outcome.message.empty()) logger_->error("{}", outcome.message);
  if (outcome.sequence_end) logger_->info("the sequence ended: {}", control::name_of(*outcome.sequence_end));
  for (std::size_t i = 0; i < outcome.last.channel_count; ++i) {
    logger_->info("{}: {}", outcome.channel_names[i], control::title_of(outcome.last.channels[i].result));
  }
  logger_->info("{} ticks, {} slips, {:.3f} s", outcome.ticks, outcome.slips, outcome.wall_s);
  const bool never_began = outcome.ending == Ending::socket_failed ||
                           outcome.ending == Ending::gpio_refused || outcome.ending == Ending::gpio_failed;
  if (never_began) return;
  if (!outcome.recording_error.empty())
    logger_->error("the recording is not whole: {}", outcome.recording_error);
  if (outcome.left_safely) {
    logger_->info("the board confirmed the safe outputs");
  } else {
    logger_->error("the board did NOT confirm the safe outputs");
  }
}

}  // namespace softgrip::daemon
