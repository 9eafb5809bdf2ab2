#include "tools/plc/client_connections.h"

#include <algorithm>
#include <tuple>

#include "base/periodic_schedule.h"

namespace softgrip::plc {

namespace {

/// Largest age of the last request of a connection that counts as in use. A client normally sends several
/// requests per second.
constexpr Nanoseconds in_use = ns_per_s;

bool is_idle(const ClientConnection& connection, Nanoseconds now) {
  return now - connection.last_request_at >= in_use;
}

}  // namespace

Command command_in(const ClientRegisters& registers) noexcept {
  const auto word = [&](Name name) { return registers[static_cast<std::size_t>(name)]; };
  return {word(Name::command), word(Name::recipe), word(Name::squeeze), word(Name::speed),
          word(Name::displacement)};
}

std::optional<ClientConnections::Id> ClientConnections::admit(const std::string& address, Nanoseconds now) {
  if (connections_.size() >= most_) {
    const Iterator victim = victim_for(address, now);
    if (victim == connections_.end()) return std::nullopt;
    connections_.erase(victim);
  }
  ClientConnection& connection = connections_[++last_id_];
  connection.address = address;
  connection.last_request_at = now;
  if (const auto past = history_.find(address); past != history_.end()) {
    connection.cursor.at = past->second.at;
  }
  return last_id_;
}

std::size_t ClientConnections::count_of(const std::string& address) const {
  return static_cast<std::size_t>(
      std::count_if(connections_.begin(), connections_.end(),
                    [&](const auto& entry) { return entry.second.address == address; }));
}

ClientConnections::Iterator ClientConnections::victim_for(const std::string& address, Nanoseconds now) {
  const bool has_none = count_of(address) == 0;
  // The rank gives the order in which connections are removed. The connections of the address with the most
  // connections come first. Among the connections of one address, those without a request come first, and
  // after them the connection with the oldest request.
  const auto rank = [&](const Iterator entry) {
    const ClientConnection& connection = entry->second;
    return std::tuple(connections_.size() - count_of(connection.address), connection.has_requested,
                      connection.last_request_at);
  };
  Iterator found = connections_.end();
  for (Iterator entry = connections_.begin(); entry != connections_.end(); ++entry) {
    const std::string& other = entry->second.address;
    const bool is_candidate = has_none ? count_of(other) > 1 : other == address;
    if (is_candidate && (found == connections_.end() || rank(entry) < rank(found))) found = entry;
  }
  const bool may_drop = has_none || found == connections_.end() || is_idle(found->second, now);
  return may_drop ? found : connections_.end();
}

ClientConnection* ClientConnections::find(Id id) noexcept {
  const auto found = connections_.find(id);
  return found == connections_.end() ? nullptr : &found->second;
}

void ClientConnections::drop_partial_requests(Id except) {
  std::erase_if(connections_, [except](const auto& entry) {
    return entry.first != except && entry.second.partial_request;
  });
}

void ClientConnections::block_starts() noexcept {
  for (auto& [id, connection] : connections_) connection.start_blocked = true;
}

void ClientConnections::require_resynchronisation(const std::string& address) {
  for (auto& [id, connection] : connections_) {
    if (connection.address == address) connection.cursor.at.reset();
  }
  history_[address].at.reset();
}

bool ClientConnections::update_heartbeat(ClientConnection& connection, std::uint16_t value) {
  AddressHistory& past = history_[connection.address];
  const bool changed = value != connection.heartbeat.value_or(past.heartbeat);
  connection.heartbeat = past.heartbeat = value;
  return changed;
}

void ClientConnections::drop_idle(Nanoseconds now, Nanoseconds longest) {
  std::erase_if(connections_,
                [=](const auto& entry) { return now - entry.second.last_request_at >= longest; });
}

}  // namespace softgrip::plc
