#include "tests/world/plc_in_world.h"

#include <algorithm>
#include <array>
#include <list>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

#include "tests/world/command_watch.h"
#include "tests/world/master_in_world.h"
#include "tools/plc/gateway.h"

namespace softgrip::world {
namespace {

using Json = nlohmann::ordered_json;
using Kind = Incident::Kind;
using plc::Gateway;

constexpr std::size_t master_count = 2;
constexpr std::array master_addresses{"10.0.0.1", "10.0.0.2"};
constexpr Nanoseconds master_period = ns_per_s / 20;
constexpr Nanoseconds wire_latency = ns_per_s / 500;
constexpr Nanoseconds gateway_pause = ns_per_s;
/// Pause between two attempts of the gateway to connect, as in tools/client/daemon_client.cpp.
constexpr Nanoseconds retry_pause = ns_per_s / 4;
constexpr const char* config_folder = SOFTGRIP_SOURCE_DIR "/config/";

plc::Settings settings_of_the_world() {
  document::Problems problems;
  auto settings = plc::load_settings(std::string(config_folder) + "plc.yaml", problems);
  if (!settings) throw std::runtime_error(problems.format());
  return std::move(*settings);
}

class PlcInWorld final : public Guest {
 public:
  explicit PlcInWorld(Host& host)
      : host_(host),
        around_(host.around()),
        settings_(settings_of_the_world()),
        watch_(nanoseconds(settings_.silence_s)),
        clock_(around_.scheduler),
        loader_(std::make_shared<const daemon::SequenceLoader>(around_.shape.rig.settings,
                                                               std::string(config_folder) + "sequences")) {
    // The heartbeat of this master never changes, so the gateway must not monitor this master.
    masters_[1].beats = false;
    watch_.on_break = [this](const char* invariant, std::string text) {
      around_.monitor.command_breaks(around_.scheduler.now(), invariant, std::move(text));
    };
  }

  void begin() override {
    start_gateway();
    for (std::size_t i = 0; i < master_count; ++i) {
      around_.scheduler.add("master", [this, i] {
        for (;;) {
          around_.scheduler.sleep_until(around_.scheduler.now() + master_period);
          cycle(i);
        }
      });
    }
  }

  void prepare(Life& life) override { life.loader = loader_; }

  void boots(DaemonInWorld& daemon) override {
    lose_daemon();
    daemon.socket->on_line = [this](const Json& line) {
      if (line["command"] == "vent") around_.monitor.asked(control::Request::Kind::vent);
      if (line["command"] == "start") around_.monitor.asked(control::Request::Kind::start);
    };
  }

  void carry_out(const Incident& incident, bool begins) override {
    MasterInWorld& master = masters_[incident.target % master_count];
    switch (incident.kind) {
      case Kind::plc_command:
        if (begins) master.want(static_cast<std::uint16_t>(incident.value));
        break;
      case Kind::plc_silent:
      case Kind::daemon_and_plc:
        master.alive = !begins;
        break;
      case Kind::plc_cut:
      case Kind::plc_half:
        if (begins) cut(incident);
        break;
      case Kind::gateway_paused:
        if (begins && gateway_) around_.scheduler.pause(actor_, around_.scheduler.now() + incident.duration);
        break;
      case Kind::gateway_dies:
        if (gateway_) kill_gateway();
        break;
      default:
        break;
    }
  }

  void look(const Excuse& excuse) override {
    const Nanoseconds now = around_.scheduler.now();
    if (!gateway_ && now >= again_at_) start_gateway();
    const bool undisturbed = gateway_ && !around_.scheduler.paused(actor_) && !excuse.no_daemon &&
                             !excuse.paused && !excuse.no_line && client_;
    watch_.passed(now, undisturbed);
    met().calls = watch_.asked();
    met().results = watch_.executed();
    met().gaps += watch_.take_silences();
  }

 private:
  // Functions of softgrip-plc. They perform the same steps as tools/plc/server.cpp, in the same order.
  void start_gateway() {
    around_.trace("softgrip-plc starts");
    gateway_.emplace(settings_);
    actor_ = around_.scheduler.add("softgrip-plc", [this] {
      for (;;) {
        turn(clock_.now());
        clock_.sleep_until(next_turn());
      }
    });
  }

  void kill_gateway() {
    around_.trace("softgrip-plc is killed");
    around_.scheduler.kill(actor_);
    hang_up();
    gateway_.reset();
    wires_.clear();
    answered_.clear();
    waiting_.reset();
    for (MasterInWorld& master : masters_) master.heard = 0;
    watch_.gateway_died();
    again_at_ = around_.scheduler.now() + gateway_pause;
  }

  [[nodiscard]] Nanoseconds next_turn() const {
    Nanoseconds next = around_.scheduler.now() + Gateway::max_update_period;
    for (const Wire& wire : wires_) {
      if (wire.flying && wire.arrived_bytes == 0) next = std::min(next, wire.arrives);
    }
    return next;
  }

  void turn(Nanoseconds now) {
    receive(now);
    watch_.look(now);
    gateway_->update(now);
    send(now, waiting_);
    if (!gateway_->handshake().has_waiting()) waiting_.reset();
    for (Wire& wire : wires_) {
      if (wire.flying && gateway_->connections().has(wire.id) && wire.arrives <= around_.scheduler.now())
        deliver(wire, now);
    }
    std::erase_if(wires_, [&](const Wire& wire) { return !gateway_->connections().has(wire.id); });
  }

  void deliver(Wire& wire, Nanoseconds now) {
    const Block block = *std::exchange(wire.flying, std::nullopt);
    const modbus::Bytes bytes = block.bytes();
    wire.stream.append(std::span(bytes).subspan(wire.arrived_bytes));
    wire.arrived_bytes = 0;
    const auto request = wire.stream.next();
    MasterInWorld& master = masters_[wire.master];
    if (!block.only_reads) {
      const bool beats = block.words[6] != wire.heartbeat.value_or(master.heard);
      if (beats) watch_.beat(now);
      wire.heartbeat = master.heard = block.words[6];
    }
    watch_.arrived(block.command);
    const bool waited = gateway_->handshake().has_waiting();
    static_cast<void>(gateway_->serve(wire.id, *request, now));
    gateway_->on_requests_served(wire.id);
    gateway_->connections().find(wire.id)->partial_request = false;
    send(now, block);
    if (!waited && gateway_->handshake().has_waiting()) waiting_ = block;
    if (!gateway_->handshake().has_waiting()) waiting_.reset();
    answered_[wire.id] = block;
    wire.reply = read_end(wire.id, now);
    // A master that has opened a newer connection closes its old one.
    if (wire.left) gateway_->connections().remove(wire.id);
  }

  [[nodiscard]] End read_end(plc::ClientConnections::Id id, Nanoseconds now) {
    modbus::Request request{1, 1, {3}};
    modbus::append_word(request.pdu, settings_.registers.at(plc::Name::done_counter));
    modbus::append_word(request.pdu, 3);
    const modbus::Reply reply = gateway_->serve(id, request, now);
    gateway_->on_requests_served(id);
    const modbus::Bytes& frame = reply.pieces.at(0).bytes;
    return {modbus::word_at(frame, 9), static_cast<plc::Outcome>(modbus::word_at(frame, 11)),
            static_cast<plc::Reason>(modbus::word_at(frame, 13))};
  }

  // Functions of the connection between the gateway and the daemon.
  void receive(Nanoseconds now) {
    if (!client_ && host_.daemon() != nullptr && (tried_at_ == 0 || now - tried_at_ >= retry_pause)) {
      tried_at_ = now;
      client_ = host_.daemon()->socket->connect();
      gateway_->on_daemon_connected(now);
    }
    if (client_ && host_.daemon() == nullptr) lose_daemon();
    if (!client_) return;
    for (const Json& line : host_.daemon()->socket->hear(*client_)) {
      watch_.answered(line);
      gateway_->on_daemon_line(line, now);
    }
  }

  void lose_daemon() {
    if (!client_) return;
    client_.reset();
    watch_.daemon_died();
    if (gateway_) gateway_->on_daemon_disconnected();
  }

  void hang_up() {
    if (client_ && host_.daemon() != nullptr) host_.daemon()->socket->hang_up(*client_);
    client_.reset();
    watch_.daemon_died();
  }

  /// Sends the messages of the gateway immediately. `cause` is the block of registers that made the gateway
  /// send these messages; nullopt: no block.
  void send(Nanoseconds now, const std::optional<Block>& cause) {
    for (const Json& line : gateway_->take_lines_to_daemon()) {
      around_.trace("softgrip-plc to the daemon: {}", line.dump());
      watch_.sent(line, cause, now);
      if (!client_ || host_.daemon() == nullptr) continue;
      host_.daemon()->socket->say(*client_, line);
      const ActorId service = host_.daemon()->actor(Part::service);
      if (service != 0) around_.scheduler.wake(service);
    }
  }

  // Functions of the masters and of their connections.
  [[nodiscard]] Wire* wire_of(std::size_t master) {
    const auto found = std::find_if(wires_.begin(), wires_.end(), [master](const Wire& wire) {
      return wire.master == master && !wire.left;
    });
    return found == wires_.end() ? nullptr : &*found;
  }

  Wire* connect(std::size_t master) {
    if (!gateway_) return nullptr;
    const auto id = gateway_->connections().admit(master_addresses[master], clock_seen());
    std::erase_if(wires_, [&](const Wire& wire) { return !gateway_->connections().has(wire.id); });
    if (!id) return nullptr;
    wires_.push_back({master, *id, {}, {}, 0, 0, false, {}, {}});
    return &wires_.back();
  }
  /// Returns the time on the clock of the daemon. Used by simulated threads that sleep by the true time.
  [[nodiscard]] Nanoseconds clock_seen() const { return around_.scheduler.shown(); }

  void cycle(std::size_t index) {
    MasterInWorld& master = masters_[index];
    Wire* wire = wire_of(index);
    if (wire == nullptr) wire = connect(index);
    if (wire == nullptr || wire->flying) return;
    if (master.alive) {
      if (const auto reply = std::exchange(wire->reply, std::nullopt))
        read(master, *reply, answered_[wire->id]);
      if (master.next(watch_.next_number(), around_.scheduler.now())) {
        watch_.ask(master.code(), master.counter());
        around_.trace("master {} commands {} with counter {}", index, master.code(), master.counter());
      }
    }
    fly(*wire, master, around_.scheduler.now() + wire_latency);
  }

  void read(MasterInWorld& master, const End& end, const Block& block) {
    const MasterInWorld::Read read = master.read(end, block, around_.scheduler.now());
    if (read.refused >= 0) watch_.read_refused(read.refused);
    if (read.accepted) watch_.read_accepted(master.code(), master.counter());
  }

  void fly(Wire& wire, MasterInWorld& master, Nanoseconds arrives) {
    wire.flying = master.block(watch_.halts());
    wire.arrives = arrives;
    around_.scheduler.wake(actor_);
  }

  /// Opens an additional connection for the master. The last block that the master has sent then arrives late
  /// on the old connection.
  void cut(const Incident& incident) {
    const std::size_t index = incident.target % master_count;
    Wire* const wire = wire_of(index);
    if (wire == nullptr) return;
    if (!wire->flying) fly(*wire, masters_[index], 0);
    wire->arrives = around_.scheduler.now() + incident.duration;
    if (incident.kind == Kind::plc_half && wire->arrived_bytes == 0 &&
        gateway_->connections().has(wire->id)) {
      const modbus::Bytes bytes = wire->flying->bytes();
      wire->arrived_bytes = bytes.size() / 2;
      wire->stream.append(std::span(bytes).first(wire->arrived_bytes));
      gateway_->connections().find(wire->id)->partial_request = wire->stream.half();
    }
    wire->left = true;
    connect(index);
  }

  Host& host_;
  Surroundings& around_;
  plc::Settings settings_;
  CommandWatch watch_;
  WorldClock clock_;
  std::shared_ptr<const daemon::SequenceLoader> loader_;
  std::optional<Gateway> gateway_;
  ActorId actor_ = 0;
  Nanoseconds again_at_ = 0;  // time at which the gateway process is restarted
  std::optional<daemon::ClientId> client_;
  Nanoseconds tried_at_ = 0;
  std::array<MasterInWorld, master_count> masters_;
  std::list<Wire> wires_;
  std::map<plc::ClientConnections::Id, Block> answered_;
  std::optional<Block> waiting_;
};

}  // namespace

std::unique_ptr<Guest> make_plc(Host& host) {
  return std::make_unique<PlcInWorld>(host);
}

}  // namespace softgrip::world
