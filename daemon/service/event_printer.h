#pragma once
// The daemon's own log: events and the reports of start and end, on the standard error.

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

/// Never used in the loop. Events of one kind that come faster than 20 in 10 s are counted instead of
/// printed.
class EventPrinter {
 public:
  /// `beside`: lines are written by a thread of the printer's own, so that a reader that hangs cannot hold up
  /// the caller; the oldest lines are lost then. Otherwise every line is written before the call returns.
  explicit EventPrinter(bool beside);

  void print(const EventEntry& event);
  /// Several lines.
  void print_report(const std::string& report);
  void print_end(const Outcome& outcome);

 private:
  struct Flow {
    double window_s = 0;  ///< when the present window began
    int printed = 0;
    int suppressed = 0;
  };
  [[nodiscard]] bool passes(const EventEntry& event);

  std::shared_ptr<spdlog::logger> logger_;
  std::shared_ptr<spdlog::details::thread_pool> writer_;  // goes first: its thread writes through the logger
  std::map<std::string, Flow> flows_;                     // by kind
};

}  // namespace softgrip::daemon
