#include "tools/plc/gateway.h"

#include <utility>

#include <nlohmann/json.hpp>

#include "base/grid.h"
#include "tools/plc/process_image.h"

namespace softgrip::plc {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* own_name = "softgrip-plc";
constexpr double watch_rate_hz = 25;
/// A daemon that says nothing for so long is none.
constexpr Nanoseconds longest_silence = ns_per_s;
constexpr Nanoseconds beat_period = ns_per_s / 10;

}  // namespace

Gateway::Gateway(const Settings& settings)
    : settings_(settings),
      registers_(make_registers(settings.registers)),
      watch_(nanoseconds(settings.silence_s)) {}

modbus::Reply Gateway::serve(const modbus::Request& request, Nanoseconds now) {
  const RegisterMap& map = settings_.registers;
  show(now);
  const modbus::Registers::Answer answer = registers_.answer(request.pdu);
  if (answer.wrote && writes(request.pdu, map.at(Name::master_heartbeat)))
    watch_.beat(registers_.holding(map.at(Name::master_heartbeat)), now);
  if (answer.wrote && writes(request.pdu, map.at(Name::command_counter))) command(now);
  modbus::Reply reply;
  reply.pieces.push_back(
      {{}, modbus::frame_on(modbus::Wire::tcp, request.transaction, request.unit, answer.pdu)});
  return reply;
}

void Gateway::command(Nanoseconds now) {
  const RegisterMap& map = settings_.registers;
  const std::uint16_t counter = registers_.holding(map.at(Name::command_counter));
  const std::uint16_t code = registers_.holding(map.at(Name::command));
  const auto kind = static_cast<CommandCode>(code);  // or none that there is
  if (!handshake_.write(counter, kind)) return;
  const auto refuse = [&](Reason reason) { handshake_.finish(counter, Outcome::refused, reason); };
  auto request = request_of(settings_, registers_);
  if (!request) return refuse(request.error());
  if (kind == CommandCode::start && watch_.silent(now)) return refuse(Reason::master_silent);
  if (!connected_) return refuse(Reason::no_daemon);
  send(std::move(*request), counter);
}

void Gateway::send(Json request, std::optional<std::uint16_t> counter) {
  request["id"] = ++last_id_;
  if (counter) asked_[last_id_] = *counter;
  to_daemon_.push_back(std::move(request));
}

void Gateway::react(Nanoseconds now) {
  if (!watch_.falls_silent(now) || settings_.when_silent == Reaction::nothing || !connected_) return;
  const CommandCode code = settings_.when_silent == Reaction::stop   ? CommandCode::stop
                           : settings_.when_silent == Reaction::vent ? CommandCode::vent
                                                                     : CommandCode::release;
  send({{"command", command_of(code)}}, std::nullopt);
}

void Gateway::look_after(Nanoseconds now) {
  // What has waited for the end of the command before it.
  if (handshake_.synchronised()) command(now);
  react(now);
}

void Gateway::daemon_came(Nanoseconds now) {
  connected_ = true;
  heard_at_ = now;
  send({{"command", "hello"}, {"client", own_name}, {"api", 1}}, std::nullopt);
  send({{"command", "watch"}, {"rate_hz", watch_rate_hz}}, std::nullopt);
}

void Gateway::daemon_went() noexcept {
  connected_ = false;
  to_daemon_.clear();
  asked_.clear();
  handshake_.lose();
  show_no_daemon(settings_.registers, registers_);
}

bool Gateway::daemon_is_silent(Nanoseconds now) const noexcept {
  return connected_ && now - heard_at_ > longest_silence;
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
  const auto asked =
      asked_.find(line.contains("id") && line["id"].is_number() ? line["id"].get<std::uint64_t>() : 0);
  if (asked == asked_.end()) return;
  const std::uint16_t counter = asked->second;
  asked_.erase(asked);
  if (line.value("ok", false)) {
    handshake_.finish(counter, Outcome::accepted);
  } else {
    handshake_.finish(counter, Outcome::refused, reason_of(line["error"]));
  }
}

/// What is the gateway's own to say.
void Gateway::show(Nanoseconds now) {
  const RegisterMap& map = settings_.registers;
  registers_.set_holding(map.at(Name::done_counter), handshake_.done_counter());
  registers_.set_holding(map.at(Name::outcome), static_cast<std::uint16_t>(handshake_.outcome()));
  registers_.set_holding(map.at(Name::reason), static_cast<std::uint16_t>(handshake_.reason()));
  registers_.set_holding(map.at(Name::heartbeat), static_cast<std::uint16_t>(now / beat_period));
  const std::uint16_t master = watch_.silent(now) ? 2 : watch_.watched() ? 1 : 0;
  registers_.set_holding(map.at(Name::master), master);
}

}  // namespace softgrip::plc
