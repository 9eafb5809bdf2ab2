#pragma once
// Serves Modbus clients on the network in one thread that never waits for a client.

#include <list>
#include <set>
#include <string>

#include "base/clock.h"
#include "base/descriptor.h"
#include "base/net/listener.h"
#include "base/net/poll_set.h"
#include "drivers/modbus_server/connection.h"
#include "tools/client/daemon_client.h"
#include "tools/plc/gateway.h"

namespace softgrip::plc {

class Server {
 public:
  /// Creates the server. `listener` comes from net::listen_tcp(). `signals` is a signalfd; any signal ends
  /// run(). All references must outlive the server.
  Server(const Settings& settings, Gateway& gateway, Descriptor listener, Descriptor signals);
  void run();

 private:
  struct Session {
    ClientConnections::Id id;
    modbus::Connection connection;
    net::PollSet::Entry poll_entry = {};
  };
  /// Closes one connection, because the process uses more descriptors than it may have. Returns false if
  /// there is no connection to close.
  [[nodiscard]] bool close_newest_session();
  /// Accepts a connection from a permitted address. Prints each refused address once.
  void accept(Nanoseconds now);
  /// Processes the events of a connection. Returns false if the connection has ended or must be closed.
  [[nodiscard]] bool serve(Session& session, net::PollSet::Events events, Nanoseconds now);

  const Settings& settings_;
  Gateway& gateway_;
  tools::DaemonLink daemon_;
  net::Acceptor acceptor_;
  Descriptor signals_;
  MonotonicClock clock_;
  std::list<Session> sessions_;
  std::set<std::string> refused_;  // addresses that were refused and printed
};

/// Returns the numeric address of the other end of a socket. An IPv4 address in IPv6 notation is returned in
/// IPv4 notation. Returns "" if the address is unknown.
[[nodiscard]] std::string address_of(int socket);

}  // namespace softgrip::plc
