#pragma once
// Stores the connections of the clients (Modbus masters), with the data of each connection. Uses no sockets.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "base/time.h"
#include "rig/plc_file/register_map.h"
#include "tools/plc/handshake.h"

namespace softgrip::plc {

/// The registers that a client writes, in the order of the enumeration Name.
using ClientRegisters = std::array<std::uint16_t, static_cast<std::size_t>(Name::master_heartbeat) + 1>;
[[nodiscard]] constexpr std::uint16_t& at(ClientRegisters& registers, Name name) {
  return registers[static_cast<std::size_t>(name)];
}
/// Returns the command that `registers` contains.
[[nodiscard]] Command command_in(const ClientRegisters& registers) noexcept;

struct ClientConnection {
  std::string address;  ///< numeric IP address of the client
  /// time of the last request; before the first request: time of the connection
  Nanoseconds last_request_at = 0;
  bool has_requested = false;    ///< true: the client has sent a complete request
  bool partial_request = false;  ///< true: the client has sent a part of a request
  /// true: the client may have sent its next requests before a silence was detected, so these requests cannot
  /// start a sequence
  bool start_blocked = false;
  /// The register values that this connection has written. Values of another connection are stored
  /// separately, so they never become part of a command of this connection.
  ClientRegisters registers{0, 0, 0, no_value, no_value, no_value, 0};
  std::optional<std::uint16_t> heartbeat;  ///< the heartbeat that this connection wrote last
  Cursor cursor;
};

class ClientConnections {
 public:
  using Id = std::uint64_t;

  explicit ClientConnections(std::size_t most) : most_(most) {}

  /// Adds a connection from a numeric address. If the number of connections is at its limit, removes the
  /// oldest idle connection of the same address, so that lost connections do not block their client. If the
  /// address has no connection, removes a connection of the address with the most connections. Returns
  /// nullopt if no connection can be removed.
  [[nodiscard]] std::optional<Id> admit(const std::string& address, Nanoseconds now);
  /// Returns the connection; null if it was removed. In this case, the owner must close the socket of the
  /// connection.
  [[nodiscard]] ClientConnection* find(Id id) noexcept;
  [[nodiscard]] bool has(Id id) const noexcept { return connections_.contains(id); }
  void remove(Id id) noexcept { connections_.erase(id); }

  /// Removes each connection except `except` that has sent a part of a request. Must be called after a write
  /// of the connection `except`, because the partial requests are older than this write.
  void drop_partial_requests(Id except);
  /// Ensures that the requests that each connection receives together next cannot start a sequence. Must be
  /// called after a silence of a client, because these requests may be older than the stop or vent that
  /// followed the silence.
  void block_starts() noexcept;
  /// Removes every connection that has sent no request for the time `longest`.
  void drop_idle(Nanoseconds now, Nanoseconds longest);
  /// Stores the counter of this connection. Later connections of the same address begin with this counter.
  void remember_counter(const ClientConnection& connection) {
    history_[connection.address].at = connection.cursor.at;
  }
  /// Blocks the commands of each connection of this address until the connection writes the newest counter.
  /// Must be called after a command of this address was refused. Without this block, another connection of
  /// the address could send the refused command or an older start, and the command would be executed.
  void require_resynchronisation(const std::string& address);
  /// Stores a heartbeat. Returns true if the heartbeat has changed since the last heartbeat of this
  /// connection. The first heartbeat of a new connection is compared with the last heartbeat of its address.
  [[nodiscard]] bool update_heartbeat(ClientConnection& connection, std::uint16_t value);

  /// Data of an address that remain stored after the connections of the address have ended. The number of
  /// these data is limited by the list of allowed addresses.
  struct AddressHistory {
    std::optional<std::uint16_t> at;
    std::uint16_t heartbeat = 0;

    friend auto operator<=>(const AddressHistory&, const AddressHistory&) = default;
  };
  [[nodiscard]] const std::map<Id, ClientConnection>& all() const noexcept { return connections_; }
  [[nodiscard]] const std::map<std::string, AddressHistory>& history() const noexcept { return history_; }

 private:
  using Iterator = std::map<Id, ClientConnection>::iterator;
  [[nodiscard]] std::size_t count_of(const std::string& address) const;
  [[nodiscard]] Iterator victim_for(const std::string& address, Nanoseconds now);

  std::size_t most_;
  std::map<Id, ClientConnection> connections_;
  std::map<std::string, AddressHistory> history_;
  Id last_id_ = 0;
};

}  // namespace softgrip::plc
