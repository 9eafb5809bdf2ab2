#pragma once
// Chooses the connection that must be closed when no place or no memory is left. Uses no sockets.

#include <cstddef>
#include <optional>
#include <vector>

#include "base/time.h"
#include "rig/web_file/settings.h"

namespace softgrip::web {

/// The properties of a connection that matter for the choice.
struct Guest {
  enum class Stay : unsigned char {
    asking,    ///< its request is not complete
    brief,     ///< the response comes from memory or from the daemon and is sent at once
    lingering  ///< an open page, a download, a wait for the disk, or a response that the client does not read
  };
  Stay stay = Stay::asking;
  Role role = Role::none;
  Nanoseconds moved_at = 0;  ///< time of arrival or of the last progress
  std::size_t unsent = 0;    ///< bytes that are not sent yet
};

/// A connection whose response has made no progress for this time may be closed in favour of another.
inline constexpr Nanoseconds long_pause = ns_per_s / 2;

/// Limit of the unsent bytes of all connections together. The sum of this limit, of the requests and of the
/// system's buffers for 512 connections is below the memory limit of the systemd unit (server.cpp).
inline constexpr std::size_t most_unsent = std::size_t{16} << 20U;

/// Returns the number of connections for which the process has enough descriptors. Each connection needs one
/// for itself and one for a file that is sent. The result is at least 4 and at most `wanted`.
/// @param descriptors  the number of descriptors that the process may have.
[[nodiscard]] std::size_t places_for(std::size_t wanted, std::size_t descriptors) noexcept;
/// Returns the number of places that lingering connections may take. The other places remain for requests
/// that are answered at once, such as stop and vent.
[[nodiscard]] constexpr std::size_t lingering_places(std::size_t places) noexcept {
  return places * 3 / 4;
}

using Victim = std::optional<std::size_t>;  ///< index of a guest

/// Chooses the connection to close when all places are taken and a client connects. Considers connections
/// whose request is still incomplete after `long_pause`. Returns the one with the lowest role, and among
/// equal roles the oldest.
[[nodiscard]] Victim gives_way_to_newcomer(const std::vector<Guest>& guests, Nanoseconds now);
/// Chooses the connection to close when all lingering places are taken and a client with `role` needs one.
/// Returns a connection with the same or a lower role whose response makes no progress, or any connection
/// with a lower role. Nullopt: refuse the client.
[[nodiscard]] Victim gives_way_to_lingering(const std::vector<Guest>& guests, Role role, Nanoseconds now);
/// Chooses the connection to close when too many bytes are unsent and a client with `role` needs memory.
/// Returns the connection with the lowest role that has made no progress for the longest time. Nullopt:
/// refuse the client.
[[nodiscard]] Victim gives_way_for_bytes(const std::vector<Guest>& guests, Role role);

[[nodiscard]] std::size_t unsent_of(const std::vector<Guest>& guests);

}  // namespace softgrip::web
