#include "tools/plc/gateway.h"

#include <utility>

#include "base/periodic_schedule.h"
#include "control/elements/fault.h"
#include "tools/plc/process_image.h"

namespace softgrip::plc {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* own_name = "softgrip-plc";
constexpr double watch_rate_hz = 25;
/// Longest time between two status lines of a daemon. If no status line arrives in this time, the daemon
/// counts as not responding.
constexpr Nanoseconds status_timeout = ns_per_s;
constexpr Nanoseconds heartbeat_period = ns_per_s / 10;
/// Largest number of commands that wait for a response of the daemon. This number of commands fits into the
/// send buffer of the socket, so sending never blocks.
constexpr std::size_t max_pending = 32;

CommandCode command_of(Reaction reaction) {
  switch (reaction) {
    case Reaction::stop:
      return CommandCode::stop;
    case Reaction::vent:
      return CommandCode::vent;
    case Reaction::release:
      return CommandCode::release;
    case Reaction::nothing:
      break;
  }
  return CommandCode::none;
}

/// Returns true if `line` is the final response to a reaction (the stop, vent or release that `when_silent`
/// selects for a silent client). A response that the daemon is busy or starting is not final, so the reaction
/// is sent again.
bool is_final(const Json& line) {
  if (line.value("ok", false)) return true;
  const Json error = line.value("error", Json::object());
  const Reason reason = reason_of(error);
  constexpr auto starting = static_cast<Reason>(static_cast<int>(Reason::refusal) +
                                                static_cast<int>(control::RefusalCode::no_valid_reading));
  return (reason > Reason::refusal && reason != starting) || error.value("code", "") == "owned";
}

}  // namespace

Gateway::Gateway(const Settings& settings)
    : settings_(settings),
      registers_(make_registers(settings.registers)),
      connections_(settings.max_masters),
      heartbeat_monitor_(nanoseconds(settings.silence_s)) {}

modbus::Reply Gateway::serve(ClientConnections::Id id, const modbus::Request& request, Nanoseconds now) {
  const RegisterMap& map = settings_.registers;
  ClientConnection& connection = *connections_.find(id);
  connection.last_request_at = now;
  connection.has_requested = true;
  write_registers(connection, now);
  const modbus::Registers::Answer answer = registers_.answer(request.pdu);
  if (answer.wrote) {
    connections_.drop_partial_requests(id);
    for (std::size_t i = 0; i < connection.registers.size(); ++i)
      connection.registers[i] = registers_.holding(map.at(static_cast<Name>(i)));
    const bool heartbeat_changed =
        writes(request.pdu, map.at(Name::master_heartbeat)) &&
        connections_.update_heartbeat(connection, at(connection.registers, Name::master_heartbeat));
    if (heartbeat_changed) {
      check_heartbeat(now);
      heartbeat_monitor_.on_change(connection.address, now);
    }
    if (writes(request.pdu, map.at(Name::command_counter))) process_counter(connection, now);
  }
  modbus::Reply reply;
  reply.pieces.push_back(
      {{}, modbus::frame_on(modbus::Wire::tcp, request.transaction, request.unit, answer.pdu)});
  return reply;
}

void Gateway::on_requests_served(ClientConnections::Id id) {
  if (ClientConnection* const connection = connections_.find(id)) connection->start_blocked = false;
}

void Gateway::process_counter(ClientConnection& connection, Nanoseconds now) {
  Handshake::Entry entry{at(connection.registers, Name::command_counter), command_in(connection.registers)};
  const bool silent = heartbeat_monitor_.state_of(connection.address, now) == HeartbeatMonitor::State::silent;
  if ((connection.start_blocked || silent) && entry.command.is(CommandCode::start))
    entry.refusal = Reason::client_silent;
  const int ahead = handshake_.ahead(entry.counter);
  if (handshake_.write(connection.cursor, entry)) execute(entry, now);
  if (!connection.cursor.refused) {
    connections_.remember_counter(connection);
  } else if (ahead == 1 || (ahead > 1 && entry.command.is_stop_or_vent())) {
    connections_.require_resynchronisation(connection.address);
  }
}

void Gateway::execute(const Handshake::Entry& entry, Nanoseconds now) {
  const auto refuse = [&](Reason reason) { handshake_.finish(entry.counter, Outcome::refused, reason); };
  if (entry.refusal != Reason::none) return refuse(entry.refusal);
  auto request = request_of(settings_, entry.command);
  if (!request) return refuse(request.error());
  if (entry.command.is(CommandCode::start) && heartbeat_monitor_.stop_required())
    return refuse(Reason::client_silent);
  // Stop and vent are sent even to a daemon that has been silent for too long, because its lines may only be
  // delayed.
  const bool responds = daemon_responds(now) || (connected_ && entry.command.is_stop_or_vent());
  if (!responds || pending_commands_.size() >= max_pending) return refuse(Reason::no_daemon);
  pending_commands_[send(std::move(*request))] = entry.counter;
}

std::uint64_t Gateway::send(Json request) {
  request["id"] = ++last_id_;
  to_daemon_.push_back(std::move(request));
  return last_id_;
}

void Gateway::check_heartbeat(Nanoseconds now) {
  if (!heartbeat_monitor_.check(now)) return;
  reaction_covers_silence_ = false;
  handshake_.refuse_waiting(Reason::client_silent);
}

/// Sends the reaction to a silent client: stop, vent or release, as `when_silent` selects. Repeats it until a
/// daemon has given a final response.
void Gateway::send_reaction(Nanoseconds now) {
  check_heartbeat(now);
  if (settings_.when_silent == Reaction::nothing) heartbeat_monitor_.confirm();
  if (!heartbeat_monitor_.stop_required()) return;
  handshake_.refuse_waiting(Reason::client_silent);
  connections_.block_starts();
  if (!connected_ || reaction_id_ || now - reaction_sent_at_ < max_update_period) return;
  reaction_id_ = send({{"command", command_of(command_of(settings_.when_silent))}});
  reaction_covers_silence_ = true;
  reaction_sent_at_ = now;
}

void Gateway::update(Nanoseconds now) {
  connections_.drop_idle(now, nanoseconds(settings_.idle_s));
  if (!daemon_responds(now)) {
    handshake_.on_daemon_lost();
    write_no_daemon(settings_.registers, registers_);
  }
  send_reaction(now);
  if (const auto waiting = handshake_.take_waiting()) execute(*waiting, now);
}

void Gateway::on_daemon_connected(Nanoseconds now) {
  connected_ = true;
  last_status_at_ = now;
  // If the daemon has no free connection, it processes only the first line, and only if this is a stop or a
  // vent. A release requires the name of its client, because another client may own the sequence.
  if (settings_.when_silent != Reaction::release) send_reaction(now);
  send({{"command", "hello"}, {"client", own_name}, {"api", 1}});
  send({{"command", "watch"}, {"rate_hz", watch_rate_hz}});
}

void Gateway::on_daemon_disconnected() noexcept {
  connected_ = false;
  to_daemon_.clear();
  pending_commands_.clear();
  reaction_id_.reset();
  handshake_.on_daemon_lost();
  write_no_daemon(settings_.registers, registers_);
}

bool Gateway::daemon_responds(Nanoseconds now) const noexcept {
  return connected_ && now - last_status_at_ <= status_timeout;
}

std::vector<std::uint16_t> Gateway::pending_counters() const {
  std::vector<std::uint16_t> counters;
  for (const auto& [id, counter] : pending_commands_) counters.push_back(counter);
  return counters;
}

std::vector<Json> Gateway::take_lines_to_daemon() {
  return std::exchange(to_daemon_, {});
}

void Gateway::on_daemon_line(const Json& line, Nanoseconds now) {
  if (line.contains("watch")) {
    last_status_at_ = now;
    write_status(line["watch"], settings_.registers, registers_);
    return;
  }
  const std::uint64_t id =
      line.contains("id") && line["id"].is_number() ? line["id"].get<std::uint64_t>() : 0;
  if (reaction_id_ == id) {
    reaction_id_.reset();
    if (reaction_covers_silence_ && is_final(line)) heartbeat_monitor_.confirm();
    return;
  }
  const auto pending = pending_commands_.find(id);
  if (pending == pending_commands_.end()) return;
  const std::uint16_t counter = pending->second;
  pending_commands_.erase(pending);
  if (line.value("ok", false)) return handshake_.finish(counter, Outcome::accepted);
  const Reason reason = reason_of(line.value("error", Json::object()));
  // If the daemon reports that the control loop did not respond in time, the loop may still begin this start.
  // The outcome of the command is then unknown.
  handshake_.finish(counter, reason == Reason::no_answer ? Outcome::unknown : Outcome::refused, reason);
}

/// Writes the registers that all clients share, and the registers that belong to this client.
void Gateway::write_registers(const ClientConnection& connection, Nanoseconds now) {
  const auto set = [&](Name name, auto value) {
    registers_.set_holding(settings_.registers.at(name), static_cast<std::uint16_t>(value));
  };
  for (std::size_t i = 0; i < connection.registers.size(); ++i)
    set(static_cast<Name>(i), connection.registers[i]);
  set(Name::done_counter, handshake_.done_counter());
  set(Name::outcome, connection.cursor.refused ? Outcome::refused : handshake_.outcome());
  set(Name::reason, connection.cursor.refused ? Reason::not_next : handshake_.reason());
  set(Name::heartbeat, now / heartbeat_period);
  using State = HeartbeatMonitor::State;
  const State state = heartbeat_monitor_.stop_required()
                          ? State::silent
                          : heartbeat_monitor_.state_of(connection.address, now);
  set(Name::master, state == State::silent ? 2 : state == State::alive ? 1 : 0);
}

}  // namespace softgrip::plc
