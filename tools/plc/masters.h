#pragma once
// The connections of the clients (Modbus masters) and the data of each. No sockets.

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

/// The registers that a client writes, in the order of Name.
using Written = std::array<std::uint16_t, static_cast<std::size_t>(Name::master_heartbeat) + 1>;
[[nodiscard]] constexpr std::uint16_t& at(Written& written, Name name) {
  return written[static_cast<std::size_t>(name)];
}
/// Returns the command in these registers.
[[nodiscard]] Command command_in(const Written& written) noexcept;

struct Master {
  std::string address;       ///< numeric
  Nanoseconds asked_at = 0;  ///< time of the last request, or of the connection
  bool asked = false;        ///< has sent a complete request
  bool half = false;         ///< has sent a part of a request
  /// The next request may be older than a silence, so it cannot start a sequence.
  bool fenced = false;
  /// Registers of this connection only, so that the writes of other connections never become part of its
  /// command.
  Written written{0, 0, 0, no_value, no_value, no_value, 0};
  std::optional<std::uint16_t> heartbeat;  ///< the last heartbeat of this connection
  Cursor cursor;
};

class Masters {
 public:
  using Id = std::uint64_t;

  explicit Masters(std::size_t most) : most_(most) {}

  /// Adds a connection from a numeric address. If all places are taken, the oldest idle connection of the
  /// same address is removed, so that lost connections do not block their client. An address without a place
  /// gets a place of the address with the most. Returns nullopt if there is no place.
  [[nodiscard]] std::optional<Id> admit(const std::string& address, Nanoseconds now);
  /// Returns null if the connection has no place. Then close the connection.
  [[nodiscard]] Master* find(Id id) noexcept;
  [[nodiscard]] bool has(Id id) const noexcept { return masters_.contains(id); }
  void leave(Id id) noexcept { masters_.erase(id); }

  /// Call it after a write of one connection. Removes the other connections with a partial request, because
  /// that request is older.
  void drop_halves(Id except);
  /// Call it after a silence. The next request of each connection may be older than the reaction to the
  /// silence, so it cannot start a sequence.
  void fence() noexcept;
  /// Removes every connection without a request for the time `longest`.
  void drop_silent(Nanoseconds now, Nanoseconds longest);
  /// Stores the counter of this connection for later connections of the same address.
  void remember_counter(const Master& master) { past_[master.address].at = master.cursor.at; }
  /// Call it after a refused command. Another connection of this address may hold the same command or an
  /// older start. These connections execute nothing until they have written the newest counter.
  void lose_step(const std::string& address);
  /// Stores a heartbeat. Returns true if it differs from the last one of the same connection, or, for a new
  /// connection, from the last one of the same address.
  [[nodiscard]] bool take_heartbeat(Master& master, std::uint16_t value);

  /// Data of an address after its connections have ended. The file limits the number of addresses.
  struct Past {
    std::optional<std::uint16_t> at;
    std::uint16_t heartbeat = 0;

    friend auto operator<=>(const Past&, const Past&) = default;
  };
  [[nodiscard]] const std::map<Id, Master>& all() const noexcept { return masters_; }
  [[nodiscard]] const std::map<std::string, Past>& past() const noexcept { return past_; }

 private:
  using Place = std::map<Id, Master>::iterator;
  [[nodiscard]] std::size_t places_of(const std::string& address) const;
  [[nodiscard]] Place to_drop_for(const std::string& address, Nanoseconds now);

  std::size_t most_;
  std::map<Id, Master> masters_;
  std::map<std::string, Past> past_;
  Id last_id_ = 0;
};

}  // namespace softgrip::plc
