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
#include "tools/web/connection_limits.h"
#include "tools/web/live_state.h"
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
    std::shared_ptr<const DiskTask> chunk;  // the next chunk of the file, which is being read from the disk;
                                            // null: no chunk is being read
  };
  struct Connection {
    Client client;
    Role role = Role::none;      // role of the client that sent the request
    StreamReader stream_reader;  // reader of the stream; used in the phase `streaming`
    Download download;           // file that is being sent; used in the phase `sending_file`
    std::uint64_t command = 0;   // number of the command that was sent to the daemon; 0: no command was sent
    std::shared_ptr<const DiskTask> task;  // pending request to the disk
    Nanoseconds deadline = 0;              // time at which the wait for the disk ends without a result
    bool closing = false;                  // true: the connection is removed at the end of this cycle
    net::PollSet::Entry poll_entry = {};
  };
  /// The connections that are not marked for removal, with the properties that determine which connection is
  /// removed next.
  struct Candidates {
    std::vector<ConnectionInfo> infos;
    std::vector<Connection*> connections;
  };

  void serve_until_signal();
  /// Closes the newest connections if the process may now have fewer descriptors than before.
  [[nodiscard]] bool reduce_connection_limit();
  void accept(Nanoseconds now);
  void process_events(Connection& connection, net::PollSet::Events events, Nanoseconds now);
  void serve(Connection& connection, Nanoseconds now);
  void request_disk(Connection& connection, DiskRequest disk_request, Nanoseconds now);
  void respond(Connection& connection, Outcome outcome, Nanoseconds now);
  void send_error(Connection& connection, int status, Nanoseconds now);
  void process_reply(Connection& connection, Nanoseconds now);
  static void process_chunk(Connection& connection);
  void request_chunk(Connection& connection);
  [[nodiscard]] bool has_same_role(const StreamReader& stream_reader, Nanoseconds now);
  /// Sends the latest messages to every open stream whose reader is still authorised.
  void send_messages(Nanoseconds now);
  void remove_closing();
  void evict(Connection& connection);
  void update_counts();

  [[nodiscard]] static ConnectionInfo info_of(const Connection& connection);
  [[nodiscard]] Candidates candidates_except(const Connection* connection);
  /// Returns true if there is space for one more connection. May close another connection to make space.
  [[nodiscard]] bool make_room_for_connection(Nanoseconds now);
  [[nodiscard]] bool make_room_for_long_lived(const Connection& connection, Nanoseconds now);
  /// Returns true if the unsent bytes of all connections are within their limit. May close other connections
  /// to meet the limit.
  [[nodiscard]] bool make_room_for_bytes(const Connection* connection, Role role);

  const Settings& settings_;
  std::size_t max_connections_;
  LiveState state_;
  ServerCounts counts_;
  Gate gate_;
  Site site_;
  DaemonWatch watch_;
  Commander commander_;
  Archive archive_;
  net::Acceptor acceptor_;
  Descriptor signals_;
  MonotonicClock clock_;
  std::list<Connection> connections_;
  Nanoseconds checked_at_ = 0;  // time at which the roles of the stream readers were last checked
};

/// Returns the number of descriptors that the process may have.
[[nodiscard]] std::size_t descriptor_limit() noexcept;

}  // namespace softgrip::web
