#pragma once
// Prints the daemon's log on the standard error: events, and the reports at start and end.

#include <chrono>
#include <map>
#include <memory>
#include <string>

#include "daemon/recording/event_log.h"
#include "daemon/service/daemon.h"

namespace spdlog {
class logger;
namespace details {
class thread_pool;
}
}  // namespace spdlog

namespace softgrip::daemon {

/// Prints events and reports. The loop does not use this class. If there are more than 20 events of one kind
/// in 10 s, the events after the first 20 are counted but not printed. The printer reports their number
/// before the first line that it prints more than 10 s after the first of these events, and before the report
/// at the end.
class EventPrinter {
 public:
  /// If `beside` is true, a thread of the printer writes the lines, so that a blocked reader cannot delay the
  /// caller. If too many lines wait for the reader, the oldest lines are lost. If `beside` is false, each
  /// line is written before the call returns.
  explicit EventPrinter(bool beside);

  void print(const EventEntry& event);
  /// Prints a report that consists of several lines.
  void print_report(const std::string& report);
  void print_end(const Outcome& outcome);
  /// Waits until all lines are written, but at most for the time `longest`.
  void wait_until_written(std::chrono::milliseconds longest);

 private:
  struct Flow {
    double window_s = 0;  ///< start time of the window in which events are counted [s]
    int printed = 0;
    int suppressed = 0;
  };
  [[nodiscard]] bool passes(const EventEntry& event);
  /// Reports the number of events that were not printed, for the windows that are over at the time `at_s`.
  void report_suppressed(double at_s);

  std::shared_ptr<spdlog::logger> logger_;
  std::shared_ptr<spdlog::details::thread_pool> writer_;  // thread that writes the lines; it uses the logger,
                                                          // so this member must be destroyed before the
                                                          // logger
  std::map<std::string, Flow> flows_;                     // number of events in the window, by kind of event
};

}  // namespace softgrip::daemon
