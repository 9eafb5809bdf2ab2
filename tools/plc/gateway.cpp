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
/// Longest time between two lines of a daemon. If no line arrives in this time, the daemon counts as
/// disconnected.
constexpr Nanoseconds longest_silence = ns_per_s;
constexpr Nanoseconds beat_period = ns_per_s / 10;
/// Largest number of commands that wait for a response of the daemon. This number of commands fits into the
/// send buffer of the socket, so sending never blocks.
constexpr std::size_t most_unanswered = 32;

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

/// Returns true if `line` is the final response to a reaction (stop or vent because a client is silent). A
/// response that the daemon is busy or starting is not final, so the reaction is sent again.
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
      masters_(settings.max_masters),
      watch_(nanoseconds(settings.silence_s)) {}

modbus::Reply Gateway::serve(Masters::Id id, const modbus::Request& request, Nanoseconds now) {
  const RegisterMap& map = settings_.registers;
  Master& master = *masters_.find(id);
  master.asked_at = now;
  master.asked = true;
  show(master, now);
  const modbus::Registers::Answer answer = registers_.answer(request.pdu);
  if (answer.wrote) {
    masters_.drop_halves(id);
    for (std::size_t i = 0; i < master.written.size(); ++i)
      master.written[i] = registers_.holding(map.at(static_cast<Name>(i)));
    const bool beats = writes(request.pdu, map.at(Name::master_heartbeat)) &&
                       masters_.take_heartbeat(master, at(master.written, Name::master_heartbeat));
    if (beats) {
      notice_silence(now);
      watch_.beat(now);
    }
    if (writes(request.pdu, map.at(Name::command_counter))) take_counter(master, now);
  }
  // The client sends its next request after it has received this response. The next request is therefore
  // newer than the silence of the client and may start a sequence.
  master.fenced = false;
  modbus::Reply reply;
  reply.pieces.push_back(
      {{}, modbus::frame_on(modbus::Wire::tcp, request.transaction, request.unit, answer.pdu)});
  return reply;
}

void Gateway::take_counter(Master& master, Nanoseconds now) {
  Handshake::Entry entry{at(master.written, Name::command_counter), command_in(master.written)};
  if (master.fenced && entry.command.is(CommandCode::start)) entry.refusal = Reason::master_silent;
  const int ahead = handshake_.ahead(entry.counter);
  if (handshake_.write(master.cursor, entry)) execute(entry, now);
  if (!master.cursor.refused) {
    masters_.remember_counter(master);
  } else if (ahead == 1 || (ahead > 1 && entry.command.halts())) {
    masters_.lose_step(master.address);
  }
}

void Gateway::execute(const Handshake::Entry& entry, Nanoseconds now) {
  const auto refuse = [&](Reason reason) { handshake_.finish(entry.counter, Outcome::refused, reason); };
  if (entry.refusal != Reason::none) return refuse(entry.refusal);
  auto request = request_of(settings_, entry.command);
  if (!request) return refuse(request.error());
  const bool starts = entry.command.is(CommandCode::start);
  if (starts && (watch_.silent(now) || watch_.owes())) return refuse(Reason::master_silent);
  // Stop and vent are sent even to a daemon that has been silent for too long, because its lines may only be
  // delayed.
  const bool hears = hears_daemon(now) || (connected_ && entry.command.halts());
  if (!hears || asked_.size() >= most_unanswered) return refuse(Reason::no_daemon);
  asked_[send(std::move(*request))] = entry.counter;
}

std::uint64_t Gateway::send(Json request) {
  request["id"] = ++last_id_;
  to_daemon_.push_back(std::move(request));
  return last_id_;
}

void Gateway::notice_silence(Nanoseconds now) {
  if (watch_.look(now)) reaction_confirms_ = false;
}

/// Sends the reaction to a silent client, which is stop or vent. Repeats it until a daemon has given a final
/// response.
void Gateway::react(Nanoseconds now) {
  notice_silence(now);
  if (settings_.when_silent == Reaction::nothing) watch_.confirm();
  if (!watch_.owes()) return;
  handshake_.refuse_waiting(Reason::master_silent);
  masters_.fence();
  if (!connected_ || reaction_ || now - reacted_at_ < longest_pause) return;
  reaction_ = send({{"command", command_of(command_of(settings_.when_silent))}});
  reaction_confirms_ = true;
  reacted_at_ = now;
}

void Gateway::look_after(Nanoseconds now) {
  masters_.drop_silent(now, nanoseconds(settings_.idle_s));
  if (!hears_daemon(now)) {
    handshake_.lose();
    show_no_daemon(settings_.registers, registers_);
  }
  react(now);
  if (const auto waited = handshake_.take_waiting()) execute(*waited, now);
}

void Gateway::daemon_came(Nanoseconds now) {
  connected_ = true;
  heard_at_ = now;
  send({{"command", "hello"}, {"client", own_name}, {"api", 1}});
  send({{"command", "watch"}, {"rate_hz", watch_rate_hz}});
}

void Gateway::daemon_went() noexcept {
  connected_ = false;
  to_daemon_.clear();
  asked_.clear();
  reaction_.reset();
  handshake_.lose();
  show_no_daemon(settings_.registers, registers_);
}

bool Gateway::hears_daemon(Nanoseconds now) const noexcept {
  return connected_ && now - heard_at_ <= longest_silence;
}

std::vector<std::uint16_t> Gateway::unanswered() const {
  std::vector<std::uint16_t> counters;
  for (const auto& [id, counter] : asked_) counters.push_back(counter);
  return counters;
}

std::vector<Json> Gateway::lines_to_daemon() {
  return std::exchange(to_daemon_, {});
}

void Gateway::daemon_said(const Json& line, Nanoseconds now) {
  if (line.contains("watch")) {
    heard_at_ = now;
    show_status(line["watch"], settings_.registers, registers_);
    return;
  }
  const std::uint64_t id =
      line.contains("id") && line["id"].is_number() ? line["id"].get<std::uint64_t>() : 0;
  if (reaction_ == id) {
    reaction_.reset();
    if (reaction_confirms_ && is_final(line)) watch_.confirm();
    return;
  }
  const auto asked = asked_.find(id);
  if (asked == asked_.end()) return;
  const std::uint16_t counter = asked->second;
  asked_.erase(asked);
  if (line.value("ok", false)) return handshake_.finish(counter, Outcome::accepted);
  const Reason reason = reason_of(line.value("error", Json::object()));
  // If the daemon reports that the control loop did not respond in time, the loop may still begin this start.
  // The outcome of the command is then unknown.
  handshake_.finish(counter, reason == Reason::no_answer ? Outcome::unknown : Outcome::refused, reason);
}

/// Writes the registers that all clients share, and the registers that belong to this client.
void Gateway::show(const Master& master, Nanoseconds now) {
  const auto set = [&](Name name, auto value) {
    registers_.set_holding(settings_.registers.at(name), static_cast<std::uint16_t>(value));
  };
  for (std::size_t i = 0; i < master.written.size(); ++i) set(static_cast<Name>(i), master.written[i]);
  set(Name::done_counter, handshake_.done_counter());
  set(Name::outcome, master.cursor.refused ? Outcome::refused : handshake_.outcome());
  set(Name::reason, master.cursor.refused ? Reason::not_next : handshake_.reason());
  set(Name::heartbeat, now / beat_period);
  set(Name::master, watch_.silent(now) || watch_.owes() ? 2 : watch_.watched() ? 1 : 0);
}

}  // namespace softgrip::plc
