#pragma once
// The connections of masters: who has a place, and what the gateway keeps of each. No sockets.

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

/// The registers that a master writes, in the order of Name.
using Written = std::array<std::uint16_t, static_cast<std::size_t>(Name::master_heartbeat) + 1>;
[[nodiscard]] constexpr std::uint16_t& at(Written& written, Name name) {
  return written[static_cast<std::size_t>(name)];
}
/// The command in them.
[[nodiscard]] Command command_in(const Written& written) noexcept;

struct Master {
  std::string address;       ///< numeric
  Nanoseconds asked_at = 0;  ///< last, or when it came
  bool asked = false;        ///< it has sent a whole request
  bool half = false;         ///< a part of a request has arrived
  /// Its next request may be older than a silence: it starts nothing.
  bool fenced = false;
  /// Its own copy: what another connection writes, or wrote before it was lost, never becomes part of this
  /// one's command.
  Written written{0, 0, 0, no_value, no_value, no_value, 0};
  std::optional<std::uint16_t> heartbeat;  ///< the last that it wrote
  Cursor cursor;
};

class Masters {
 public:
  using Id = std::uint64_t;

  explicit Masters(std::size_t most) : most_(most) {}

  /// A connection from a numeric address. When all places are taken, the oldest idle one of the same address
  /// is dropped: a master that lost its connections is not locked out by them. An address without a place
  /// takes one from the address that has the most. Nothing: there is no place.
  [[nodiscard]] std::optional<Id> admit(const std::string& address, Nanoseconds now);
  /// Null: it has no place (any more), and its connection is to be closed.
  [[nodiscard]] Master* find(Id id) noexcept;
  [[nodiscard]] bool has(Id id) const noexcept { return masters_.contains(id); }
  void leave(Id id) noexcept { masters_.erase(id); }

  /// A connection has written: what others have sent half is older than that, and those are dropped.
  void drop_halves(Id except);
  /// The masters were silent. A request that has already arrived may be older than the reaction to that: the
  /// next request of each connection starts nothing.
  void fence() noexcept;
  /// Drops every connection that has asked nothing for the time `longest`.
  void drop_silent(Nanoseconds now, Nanoseconds longest);
  /// A later connection of the same address begins with this one's counter.
  void remember_counter(const Master& master) { past_[master.address].at = master.cursor.at; }
  /// A command of an address was refused on one of its connections, and another one may hold it, or a start
  /// that is older. None of them executes anything until it has written the newest counter.
  void lose_step(const std::string& address);
  /// A master has written a heartbeat. Returns true if it has changed: against the last one of the same
  /// connection, or for the first one of a connection against the last one of the same address.
  [[nodiscard]] bool take_heartbeat(Master& master, std::uint16_t value);

  /// The memory of an address whose connections have ended. There are as many as the file allows.
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
