#include "tools/web/connection_limits.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace softgrip::web {

namespace {

/// Number of descriptors that the program itself needs: standard streams, listener, signals, two connections
/// to the daemon, the disk thread, and a reserve for descriptors that are open for a short time.
constexpr std::size_t reserved_descriptors = 24;
constexpr std::size_t min_connections = 4;

/// Returns the connection with the lowest role among the connections for which `is_candidate` returns true.
/// If several connections have this role, returns the connection whose last progress is the oldest.
template <class IsCandidate>
Victim first_to_close(const std::vector<ConnectionInfo>& connections, const IsCandidate& is_candidate) {
  const auto rank = [](const ConnectionInfo& connection) {
    return std::tuple(connection.role, connection.last_progress_at);
  };
  Victim victim;
  for (std::size_t i = 0; i < connections.size(); ++i) {
    if (is_candidate(connections[i]) && (!victim || rank(connections[i]) < rank(connections[*victim])))
      victim = i;
  }
  return victim;
}

}  // namespace

std::size_t max_connections_for(std::size_t configured, std::size_t descriptors) noexcept {
  const std::size_t left = descriptors > reserved_descriptors ? descriptors - reserved_descriptors : 0;
  return std::min(configured, std::max(min_connections, left / 2));
}

Victim victim_for_new_connection(const std::vector<ConnectionInfo>& connections, Nanoseconds now) {
  return first_to_close(connections, [now](const ConnectionInfo& connection) {
    return connection.kind == ConnectionInfo::Kind::receiving &&
           now - connection.last_progress_at > stall_limit;
  });
}

Victim victim_for_long_lived(const std::vector<ConnectionInfo>& connections, Role role, Nanoseconds now) {
  return first_to_close(connections, [&](const ConnectionInfo& connection) {
    if (connection.kind != ConnectionInfo::Kind::long_lived) return false;
    const bool is_stalled = connection.unsent > 0 && now - connection.last_progress_at > stall_limit;
    return connection.role < role || (connection.role == role && is_stalled);
  });
}

Victim victim_for_memory(const std::vector<ConnectionInfo>& connections, Role role) {
  return first_to_close(connections, [role](const ConnectionInfo& connection) {
    return connection.unsent > 0 && connection.role <= role;
  });
}

std::size_t total_unsent(const std::vector<ConnectionInfo>& connections) {
  return std::accumulate(
      connections.begin(), connections.end(), std::size_t{0},
      [](std::size_t sum, const ConnectionInfo& connection) { return sum + connection.unsent; });
}

}  // namespace softgrip::web
