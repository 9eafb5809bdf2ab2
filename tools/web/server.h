#pragma once
// Browsers on the network, in one thread that never waits for any of them.

#include <list>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/descriptor.h"
#include "tools/web/client.h"
#include "tools/web/commander.h"
#include "tools/web/daemon_watch.h"
#include "tools/web/site.h"

namespace softgrip::web {

class Server {
 public:
  /// `listener`: of modbus::listen_tcp(). `signals`: a signalfd; any signal ends run(). `settings` outlives
  /// it.
  Server(const Settings& settings, Tokens tokens, std::string chart_js, Descriptor listener,
         Descriptor signals);
  void run();

 private:
  struct Visitor {
    Client client;
    Follower follower;  // while it follows
  };

  void accept(Nanoseconds now);
  [[nodiscard]] bool make_place(Nanoseconds now);
  /// False: he has gone, or is to be shown out.
  [[nodiscard]] bool look_after(Visitor& visitor, short events, Nanoseconds now);
  void serve(Visitor& visitor, Nanoseconds now);
  void answer(Visitor& visitor, Outcome outcome, Nanoseconds now);
  void refuse(Visitor& visitor, int status, Nanoseconds now);
  void take_answer(Visitor& visitor, Nanoseconds now);
  [[nodiscard]] bool still_may(const Follower& follower, Nanoseconds now);
  /// Who follows hears what is new, as long as he may.
  void tell_news(Nanoseconds now);

  const Settings& settings_;
  LiveState state_;
  OwnCounts counts_;
  Gate gate_;
  Site site_;
  DaemonWatch watch_;
  Commander commander_;
  Descriptor listener_;
  Descriptor signals_;
  MonotonicClock clock_;
  std::list<Visitor> visitors_;
  Nanoseconds checked_at_ = 0;  // whether followers still may
};

}  // namespace softgrip::web
