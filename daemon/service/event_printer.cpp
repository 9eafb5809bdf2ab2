#include "daemon/service/event_printer.h"

#include <poll.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <limits>
#include <mutex>
#include <sstream>
#include <thread>

#include <spdlog/async.h>
#include <spdlog/sinks/base_sink.h>
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

/// Longest time for which a line waits if the reader of the standard error is blocked [ms]. The lines after
/// this line do not wait.
constexpr int patience_ms = 200;

/// Writes lines to the standard error, whose reader may be blocked. Drops a line that cannot be written, so
/// that the daemon can always end.
class StandardError final : public spdlog::sinks::base_sink<std::mutex> {
 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t text;
    formatter_->format(message, text);
    std::string line(text.data(), text.size());
    if (colours_ && message.color_range_end > message.color_range_start) {
      line.insert(message.color_range_end, "\033[0m");
      line.insert(message.color_range_start, colour_of(message.level));
    }
    write(line);
  }
  void flush_() override {}

 private:
  static const char* colour_of(spdlog::level::level_enum level) {
    return level >= spdlog::level::err    ? "\033[31m\033[1m"
           : level == spdlog::level::warn ? "\033[33m\033[1m"
                                          : "\033[32m";
  }
  /// Writes a line if the pipe is ready. A pipe that is ready accepts a complete line, so the write does not
  /// block.
  void write(const std::string& line) {
    pollfd ready{.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
    const bool writable = ::poll(&ready, 1, blocked_ ? 0 : patience_ms) > 0;
    blocked_ = !writable;
    // If this write fails, there is no other output that could report the failure.
    if (writable) [[maybe_unused]]
      const ssize_t written = ::write(STDERR_FILENO, line.data(), line.size());
  }

  bool colours_ = isatty(STDERR_FILENO) != 0;
  bool blocked_ = false;
};

}  // namespace

EventPrinter::EventPrinter(bool beside) {
  auto sink = std::make_shared<StandardError>();
  if (beside) {
    // The thread of the writer must block all signals. A signal in this thread would end the process before
    // the safe outputs are written.
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
  // The journal adds the time to each line, so the line needs no time.
  const bool journal = std::getenv("JOURNAL_STREAM") != nullptr;
  logger_->set_pattern(journal ? "%l: %v" : "%H:%M:%S.%e %^%l%$: %v");
  logger_->flush_on(spdlog::level::info);
}

void EventPrinter::report_suppressed(double at_s) {
  for (auto& [kind, flow] : flows_) {
    if (flow.suppressed == 0 || at_s - flow.window_s <= window_s) continue;
    logger_->warn("{} further events of the kind {} were not printed", flow.suppressed, kind);
    flow.suppressed = 0;
  }
}

bool EventPrinter::passes(const EventEntry& event) {
  report_suppressed(event.time_s);
  Flow& flow = flows_[event.kind];
  if (event.time_s - flow.window_s > window_s) flow = {.window_s = event.time_s};
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

void EventPrinter::wait_until_written(std::chrono::milliseconds longest) {
  if (!writer_) return;
  // The writer takes this message from its queue after it has written all earlier lines.
  writer_->post_flush(std::dynamic_pointer_cast<spdlog::async_logger>(logger_),
                      spdlog::async_overflow_policy::overrun_oldest);
  const auto give_up = std::chrono::steady_clock::now() + longest;
  while (writer_->queue_size() > 0 && std::chrono::steady_clock::now() < give_up)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

void EventPrinter::print_end(const Outcome& outcome) {
  report_suppressed(std::numeric_limits<double>::infinity());
  if (!outcome.message.empty()) logger_->error("{}", outcome.message);
  if (outcome.sequence_end) logger_->info("the sequence ended: {}", control::name_of(*outcome.sequence_end));
  for (std::size_t i = 0; i < outcome.last.channel_count; ++i) {
    logger_->info("{}: {}", outcome.channel_names[i], control::title_of(outcome.last.channels[i].result));
  }
  logger_->info("{} ticks, {} overruns, {:.3f} s", outcome.ticks, outcome.overruns, outcome.wall_s);
  if (!reached_the_board(outcome.ending)) return;
  if (!outcome.recording_error.empty())
    logger_->error("the recording is incomplete: {}", outcome.recording_error);
  if (outcome.safe_state_confirmed) {
    logger_->info("the board confirmed the safe outputs");
    if (const std::string sentence = left_on_sentence(outcome); !sentence.empty())
      logger_->warn("{}", sentence);
  } else {
    logger_->error("the board did NOT confirm the safe outputs");
  }
}

}  // namespace softgrip::daemon
