#pragma once
// Serves browsers on the network in one thread. The thread never waits for a client or for the disk.

#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "base/clock.h"
#include "base/descriptor.h"
#include "base/net/listener.h"
#include "base/net/poll_set.h"
#include "tools/web/archive.h"
#include "tools/web/client.h"
#include "tools/web/commander.h"
#include "tools/web/daemon_watch.h"
#include "tools/web/places.h"
#include "tools/web/site.h"

namespace softgrip::web {

class Server {
 public:
  /// Creates the server. `listener` comes from net::listen_tcp(). `signals` is a signalfd; any signal ends
  /// run(). `settings` must outlive the server.
  Server(const Settings& settings, Tokens tokens, std::string chart_js, Descriptor listener,
         Descriptor signals);
  void run();

 private:
  /// A file that is being sent to a client.
  struct Download {
    std::shared_ptr<const RegularFile> file;
    std::size_t read = 0;                   // number of bytes of the file that have been read so far
    std::shared_ptr<const DiskTask> piece;  // the next piece of the file, which is being read from the disk;
                                            // null: no piece is being read
  };
  struct Visitor {
    Client client;
    Role role = Role::none;     // role of the visitor that sent the request
    Follower follower;          // reader of the stream; used in the phase `following`
    Download download;          // file that is being sent; used in the phase `loading`
    std::uint64_t command = 0;  // number of the command that was sent to the daemon; 0: no command was sent
    std::shared_ptr<const DiskTask> task;  // pending request to the disk
    Nanoseconds gives_up_at = 0;           // time at which the wait for the disk ends without a result
    bool leaves = false;                   // true: the visitor is removed at the end of this cycle
    net::PollSet::Place place = {};
  };
  /// The visitors that are not marked for removal, with the properties that determine which visitor is
  /// removed next.
  struct Crowd {
    std::vector<Guest> guests;
    std::vector<Visitor*> visitors;
  };

  void serve_until_signal();
  /// Closes the newest visitors if the process may now have fewer descriptors than before.
  [[nodiscard]] bool give_up_places();
  void accept(Nanoseconds now);
  void look_after(Visitor& visitor, net::PollSet::Events events, Nanoseconds now);
  void serve(Visitor& visitor, Nanoseconds now);
  void ask_disk(Visitor& visitor, DiskRequest disk_request, Nanoseconds now);
  void answer(Visitor& visitor, Outcome outcome, Nanoseconds now);
  void refuse(Visitor& visitor, int status, Nanoseconds now);
  void take_reply(Visitor& visitor, Nanoseconds now);
  static void take_piece(Visitor& visitor);
  void ask_for_piece(Visitor& visitor);
  [[nodiscard]] bool still_may(const Follower& follower, Nanoseconds now);
  /// Sends the latest messages to every open stream whose reader is still authorised.
  void tell_news(Nanoseconds now);
  void remove_leaving();
  void turn_away(Visitor& visitor);
  void count();

  [[nodiscard]] static Guest guest_of(const Visitor& visitor);
  [[nodiscard]] Crowd crowd_beside(const Visitor* visitor);
  /// Returns true if there is space for one more connection. May close another connection to make space.
  [[nodiscard]] bool make_place(Nanoseconds now);
  [[nodiscard]] bool make_lingering_place(const Visitor& visitor, Nanoseconds now);
  /// Returns true if the unsent bytes of all connections are within their limit. May close other connections
  /// to meet the limit.
  [[nodiscard]] bool make_room(const Visitor* visitor, Role role);

  const Settings& settings_;
  std::size_t places_;
  LiveState state_;
  OwnCounts counts_;
  Gate gate_;
  Site site_;
  DaemonWatch watch_;
  Commander commander_;
  Archive archive_;
  net::Entrance entrance_;
  Descriptor signals_;
  MonotonicClock clock_;
  std::list<Visitor> visitors_;
  Nanoseconds checked_at_ = 0;  // time at which the roles of the stream readers were last checked
};

/// Returns the number of descriptors that the process may have.
[[nodiscard]] std::size_t descriptor_limit() noexcept;

}  // namespace softgrip::web
