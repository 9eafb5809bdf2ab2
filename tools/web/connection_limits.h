#pragma once
// Selects the connection to close when the number of connections or the memory reaches its limit. Uses no
// sockets.

#include <cstddef>
#include <optional>
#include <vector>

#include "base/time.h"
#include "rig/web_file/settings.h"

namespace softgrip::web {

/// The properties of a connection that determine if it is closed.
struct ConnectionInfo {
  enum class Kind : unsigned char {
    receiving,    ///< the request of the connection is not complete
    short_lived,  ///< the response comes from memory or from the daemon and is sent at once
    long_lived    ///< an open page, a download, a wait for the disk, or a response that the client does not
                  ///< read
  };
  Kind kind = Kind::receiving;
  Role role = Role::none;
  Nanoseconds last_progress_at = 0;  ///< time of the last progress of the connection; if there was none, time
                                     ///< at which the client connected
  std::size_t unsent = 0;            ///< number of bytes that wait to be sent
};

/// Time without progress of a response after which its connection may be closed to make space for another
/// connection.
inline constexpr Nanoseconds stall_limit = ns_per_s / 2;

/// Limit of the unsent bytes of all connections together. The memory limit of the systemd unit exceeds the
/// sum of this limit, the requests and the system's buffers for 512 connections (server.cpp).
inline constexpr std::size_t max_unsent = std::size_t{16} << 20U;

/// Returns the number of connections for which the process has a sufficient number of descriptors. Each
/// connection needs two descriptors: one for its socket and one for a file that is sent. The result is at
/// least 4 and at most `configured`.
/// @param descriptors  the number of descriptors that the process may have.
[[nodiscard]] std::size_t max_connections_for(std::size_t configured, std::size_t descriptors) noexcept;
/// Returns the largest number of long-lived connections (ConnectionInfo::Kind). All other connections are
/// reserved for requests that are answered at once, such as stop and vent.
[[nodiscard]] constexpr std::size_t max_long_lived(std::size_t max_connections) noexcept {
  return max_connections * 3 / 4;
}

using Victim = std::optional<std::size_t>;  ///< index of the connection to close; nullopt: no connection can
                                            ///< be closed

/// Selects the connection to close when a client connects and the number of connections is at its limit. The
/// candidates are connections whose request is still incomplete after `stall_limit`. Returns the candidate
/// with the lowest role; if several have this role, the oldest of them.
[[nodiscard]] Victim victim_for_new_connection(const std::vector<ConnectionInfo>& connections,
                                               Nanoseconds now);
/// Selects the connection to close when a client with `role` needs a long-lived connection and the number of
/// long-lived connections is at its limit. Returns a connection with a lower role, or a connection with the
/// same role whose response makes no progress. Returns nullopt if there is none; the client is then refused.
[[nodiscard]] Victim victim_for_long_lived(const std::vector<ConnectionInfo>& connections, Role role,
                                           Nanoseconds now);
/// Selects the connection to close when too many bytes are unsent and a client with `role` needs memory.
/// Among the connections with the lowest role, returns the connection that has made no progress for the
/// longest time. Returns nullopt if no connection may be closed; the client is then refused.
[[nodiscard]] Victim victim_for_memory(const std::vector<ConnectionInfo>& connections, Role role);

[[nodiscard]] std::size_t total_unsent(const std::vector<ConnectionInfo>& connections);

}  // namespace softgrip::web
