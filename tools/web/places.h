#pragma once
// Chooses the connection that gives way when places or memory run out. No sockets.

#include <cstddef>
#include <optional>
#include <vector>

#include "base/time.h"
#include "rig/web_file/settings.h"

namespace softgrip::web {

/// A connection, as far as it matters here.
struct Guest {
  enum class Stay : unsigned char {
    asking,    ///< its request is not complete
    brief,     ///< its answer comes from memory or from the daemon, and goes out at once
    lingering  ///< an open page, a download, a wait for the disk, an answer that is not taken
  };
  Stay stay = Stay::asking;
  Role role = Role::none;
  Nanoseconds moved_at = 0;  ///< when it came, or when bytes last moved
  std::size_t unsent = 0;    ///< bytes that the program keeps for it
};

/// A connection without progress for this time may lose its place to another.
inline constexpr Nanoseconds long_pause = ns_per_s / 2;

/// All bytes that the program keeps for all connections together. With the requests and the system's buffers
/// of 512 connections this stays below the memory that the unit allows (server.cpp).
inline constexpr std::size_t most_unsent = std::size_t{16} << 20U;

/// The number of connections for which there are descriptors: one for each, and one for the file that it may
/// be sent. At least 4, at most `wanted`.
/// @param descriptors  that the process may have.
[[nodiscard]] std::size_t places_for(std::size_t wanted, std::size_t descriptors) noexcept;
/// Returns the number of places that lingering connections may take. The others remain for requests that are
/// answered at once, such as stop and vent.
[[nodiscard]] constexpr std::size_t lingering_places(std::size_t places) noexcept {
  return places * 3 / 4;
}

using Victim = std::optional<std::size_t>;  ///< index of a guest

/// All places are taken and a client comes. Returns the connection with the lowest role, then the oldest,
/// whose request is still incomplete after its time.
[[nodiscard]] Victim gives_way_to_newcomer(const std::vector<Guest>& guests, Nanoseconds now);
/// All lingering places are taken and a client with this role wants one. Returns one that takes nothing and
/// has no higher role, or one with a lower role. Nothing: the client is refused.
[[nodiscard]] Victim gives_way_to_lingering(const std::vector<Guest>& guests, Role role, Nanoseconds now);
/// More bytes wait than may, and a client with this role needs room. Returns the one with the lowest role
/// that has taken nothing for longest. Nothing: the client is refused.
[[nodiscard]] Victim gives_way_for_bytes(const std::vector<Guest>& guests, Role role);

[[nodiscard]] std::size_t unsent_of(const std::vector<Guest>& guests);

}  // namespace softgrip::web
