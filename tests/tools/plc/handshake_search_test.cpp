// Searches breadth first through all orders of the actions of two masters, the gateway and the daemon, until
// no new state appears. Each participant can repeat or delay an action, send half a request, or die. The
// search runs the real gateway: it passes the bytes of requests to the gateway and reads the lines for the
// daemon. The masters and the daemon are minimal programs that follow their protocols.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/periodic_schedule.h"
#include "tools/plc/gateway.h"

namespace softgrip::plc::handshake_search_test {
namespace {

using Json = nlohmann::ordered_json;

/// Length of one step of the simulated time. A master counts as silent after two steps without a heartbeat.
/// After one step without a request, a new connection may replace a connection. After one step, a daemon that
/// sends nothing counts as silent.
constexpr Nanoseconds step = ns_per_s * 3 / 2;
constexpr int silent_steps = 2;
constexpr std::size_t plcs = 2;
constexpr std::uint16_t start = 1;
constexpr std::uint16_t vent = 3;

/// Remaining number of actions of each kind. The numbers are limited, so that the search ends.
struct Budget {
  std::array<int, plcs> commands{};
  std::array<int, plcs> connections{};
  int master_deaths = 0;
  int gateway_deaths = 0;
  int daemon_deaths = 0;
  int pauses = 0;
  int busy = 0;
  bool impatient = false;  // true: masters may request a start while another command is executing
  bool time = false;       // true: the time may advance, and the heartbeat of the first master may change
};

Settings settings_of_the_search() {
  document::Problems problems;
  Settings settings = *load_settings(SOFTGRIP_SOURCE_DIR "/config/plc.yaml", problems);
  settings.max_masters = plcs;
  settings.idle_s = 1e6;  // so long that the gateway never closes a connection because of this time
  settings.registers.most_fingers = 1;
  return settings;
}

/// A block of registers that a master has written and that the gateway has not received yet.
struct Frame {
  std::array<std::uint16_t, 7> words{};
  int command = -1;  // index of the command in the list of all commands; -1: no command
  int halts = 0;     // number of stops and vents that were executed before the block was written

  [[nodiscard]] modbus::Bytes bytes() const {
    modbus::Bytes pdu{16, 0, 0, 0, 7, 14};
    for (const std::uint16_t word : words) modbus::append_word(pdu, word);
    return modbus::frame_on(modbus::Wire::tcp, 1, 1, pdu);
  }
};

/// A connection of a master. The master sends a request after it has received the response to its previous
/// request.
struct Wire {
  std::size_t plc = 0;
  ClientConnections::Id id = 0;
  modbus::RequestStream stream;
  std::optional<Frame> flying;
  bool half = false;                       // true: the gateway has received the first half of the pending
                                           // block
  std::optional<std::uint16_t> heartbeat;  // the last heartbeat that the gateway received on this connection
};

enum class Progress { begins, synchronises, ready, waits };

struct Plc {
  bool alive = true;
  Progress progress = Progress::begins;
  std::uint16_t counter = 0;
  std::uint16_t code = 0;
  int command = -1;
  std::uint16_t heartbeat = 0;
  std::uint16_t heard = 0;  // the last heartbeat of this master that the gateway received
  // The connection on which the gateway has responded to the present block of the master. On this connection,
  // the master reads the outcome of its command.
  ClientConnections::Id answered_on = 0;
};

/// A command that a master has requested, and the progress of this command.
struct Command {
  std::uint16_t code = 0;
  std::uint16_t counter = 0;
  bool executed = false;
  // True in three cases: the daemon was busy and refused the command; the command was executed, and a later
  // command has been executed since; the command was executed, and the gateway has died since.
  bool over = false;
  bool reported_refused = false;
};

struct Line {
  std::uint64_t id = 0;
  std::string command;
  int asked = -1;  // index of the command in the list of all commands; -1: the line belongs to no command
};

struct Answer {
  std::uint64_t id = 0;
  bool accepted = false;  ///< false: the daemon is busy
};

struct World {
  explicit World(const Settings& with) : settings(&with), gateway(std::in_place, with) {}

  const Settings* settings;
  Budget left;
  Nanoseconds now = 100 * ns_per_s;
  std::optional<Gateway> gateway;
  std::array<Plc, plcs> masters;
  std::vector<Wire> wires;
  std::vector<Command> commands;
  // State of the simulated daemon.
  bool runs = false;
  bool paused = false;
  std::vector<Line> lines;      // the oldest line first
  std::vector<Answer> answers;  // the oldest answer first
  // Data that the search records for its checks.
  int halts = 0;  // number of executed stops and vents, including stops because of a silent master
  std::optional<Frame> waiting;
  struct Heartbeat {
    bool watched = false;
    bool stopped_since_beat = false;
    int steps = 0;  // time since the last change of the heartbeat
  };
  std::array<Heartbeat, plcs> heartbeats{};
  bool owed = false;  // true: a master has become silent, and no daemon has executed a stop since then
  Nanoseconds reacted_at = 0;
  std::string broken;

  [[nodiscard]] Wire* wire_of(std::size_t plc) {
    const auto found =
        std::find_if(wires.rbegin(), wires.rend(), [&](const Wire& w) { return w.plc == plc; });
    return found == wires.rend() ? nullptr : &*found;
  }
  static std::string address_of(std::size_t plc) { return plc == 0 ? "10.0.0.1" : "10.0.0.2"; }

  void check(bool holds, const char* otherwise) {
    if (!holds && broken.empty()) broken = otherwise;
  }

  /// Transfers the lines of the gateway to the daemon immediately. `cause` is the block of registers that
  /// made the gateway send these lines.
  void carry(const std::optional<Frame>& cause) {
    for (const Json& line : gateway->take_lines_to_daemon()) {
      const std::string command = line["command"];
      if (command == "start" || command == "vent") executes(command, cause);
      if (command == "stop") {
        ++halts;
        reacted_at = now;
      }
      if (command != "hello" && command != "watch")
        lines.push_back({line["id"], command, cause && command != "stop" ? cause->command : -1});
    }
  }
  void executes(const std::string& command, const std::optional<Frame>& cause) {
    check(cause && cause->command >= 0, "a command is executed that no master has requested");
    if (!broken.empty()) return;
    Command& asked = commands[static_cast<std::size_t>(cause->command)];
    check((asked.code == start) == (command == "start"),
          "the executed command differs from the requested one");
    check(!asked.executed, "a command is executed twice");
    check(!asked.reported_refused, "a command was reported as refused, but is executed");
    check(asked.code != start || cause->halts == halts,
          "a start is executed although a stop or a vent was executed after the start was written");
    if (asked.code == vent) ++halts;
    for (Command& other : commands) other.over = other.over || other.executed;
    asked.executed = true;
  }

  void turn() {
    gateway->update(now);
    carry(waiting);
    drop_closed();
  }
  void drop_closed() {
    std::erase_if(wires, [&](const Wire& wire) { return !gateway->connections().has(wire.id); });
  }

  // Actions of a master. The earlier connections of the master remain open, because the gateway cannot
  // distinguish a dead connection from a slow one.
  bool connect(std::size_t plc) {
    const auto id = gateway->connections().admit(address_of(plc), now);
    drop_closed();
    if (id) wires.push_back({plc, *id, {}, {}, false, {}});
    return id.has_value();
  }
  /// Sends the present block of a master. A master sends this block in every cycle, even if its program has
  /// stopped.
  void write(std::size_t plc) { write_on(*wire_of(plc)); }
  void write_on(Wire& wire) {
    Plc& master = masters[wire.plc];
    // The heartbeat of the first master changes. The heartbeat of the second master is constant.
    if (left.time && wire.plc == 0 && master.alive) master.heartbeat = master.heartbeat == 1 ? 2 : 1;
    if (left.time && wire.plc == 1) master.heartbeat = 9;
    Frame frame;
    frame.words = {master.counter, master.code, 1, no_value, no_value, no_value, master.heartbeat};
    frame.command = master.command;
    frame.halts = halts;
    wire.flying = frame;
  }
  void deliver_half(Wire& wire) {
    const modbus::Bytes bytes = wire.flying->bytes();
    wire.stream.append(std::span(bytes).first(bytes.size() / 2));
    wire.half = true;
    check(!wire.stream.next().has_value(), "an incomplete request is accepted as a complete request");
    gateway->connections().find(wire.id)->partial_request = wire.stream.half();
  }
  void deliver(std::size_t index) {
    Wire& wire = wires[index];
    const Frame frame = *std::exchange(wire.flying, std::nullopt);
    const modbus::Bytes bytes = frame.bytes();
    wire.stream.append(std::span(bytes).subspan(wire.half ? bytes.size() / 2 : 0));
    wire.half = false;
    const auto request = wire.stream.next();
    const bool waited = gateway->handshake().has_waiting();
    static_cast<void>(gateway->serve(wire.id, *request, now));
    if (!wire.stream.half()) gateway->on_requests_served(wire.id);
    gateway->connections().find(wire.id)->partial_request = wire.stream.half();
    carry(frame);
    if (!waited && gateway->handshake().has_waiting()) waiting = frame;
    if (!gateway->handshake().has_waiting()) waiting.reset();
    Plc& master = masters[wire.plc];
    if (frame.words[6] != wire.heartbeat.value_or(master.heard)) heartbeats[wire.plc] = {true, false, 0};
    wire.heartbeat = master.heard = frame.words[6];
    const bool is_current = frame.words[0] == master.counter && frame.words[1] == master.code;
    if (is_current && frame.command == master.command) master.answered_on = wire.id;
    if (master.progress == Progress::synchronises && frame.words[0] == master.counter && frame.words[1] == 0)
      master.progress = Progress::ready;
    drop_closed();
  }
  std::array<std::uint16_t, 3> read(ClientConnections::Id id) {
    modbus::Request request{1, 1, {3}};
    modbus::append_word(request.pdu, settings->registers.at(Name::done_counter));
    modbus::append_word(request.pdu, 3);
    const modbus::Reply reply = gateway->serve(id, request, now);
    gateway->on_requests_served(id);
    const modbus::Bytes& frame = reply.pieces.at(0).bytes;
    return {modbus::word_at(frame, 9), modbus::word_at(frame, 11), modbus::word_at(frame, 13)};
  }
  /// Reads the outcome of the master's command and continues with the next step of the protocol in
  /// docs/reference/plc-map.md.
  void look(std::size_t plc) {
    Plc& master = masters[plc];
    const auto [done, outcome_word, reason_word] = read(wire_of(plc)->id);
    const auto outcome = static_cast<Outcome>(outcome_word);
    const auto reason = static_cast<Reason>(reason_word);
    const bool lost_step = outcome == Outcome::refused && reason == Reason::not_next;
    if (master.progress == Progress::begins) {
      if (outcome == Outcome::executing) return;
      master = {master.alive, Progress::synchronises, done, 0, -1, master.heartbeat, master.heard, 0};
    } else if (lost_step) {
      if (master.command >= 0) report_refused(master.command);
      master.progress = Progress::begins;
    } else if (master.progress == Progress::waits && done == master.counter &&
               outcome != Outcome::executing) {
      if (outcome == Outcome::accepted) judge_accepted(master);
      if (outcome == Outcome::refused && reason != Reason::first_after_start) report_refused(master.command);
      master.progress = Progress::ready;
    }
  }
  void report_refused(int command) {
    Command& asked = commands[static_cast<std::size_t>(command)];
    check(!asked.executed || asked.over, "a command was executed, but is reported as refused");
    asked.reported_refused = true;
  }
  /// Checks that a command has been executed if the gateway reports it as accepted. If two masters request
  /// the same command with the same counter, both read the same outcome.
  void judge_accepted(const Plc& master) {
    const bool executed = std::any_of(commands.begin(), commands.end(), [&](const Command& asked) {
      return asked.executed && asked.counter == master.counter && asked.code == master.code;
    });
    check(executed, "a command was not executed, but is reported as accepted");
  }
  void ask(std::size_t plc, std::uint16_t code) {
    Plc& master = masters[plc];
    master.command = static_cast<int>(commands.size());
    master.code = code;
    ++master.counter;
    master.progress = Progress::waits;
    master.answered_on = 0;
    commands.push_back({code, master.counter, false, false, false});
  }

  // The functions below are actions of the simulated daemon.
  void daemon_starts() {
    runs = true;
    gateway->on_daemon_connected(now);
    carry({});
  }
  void daemon_dies() {
    runs = paused = false;
    lines.clear();
    answers.clear();
    gateway->on_daemon_disconnected();
  }
  void daemon_takes(bool busy) {
    const Line line = lines.front();
    lines.erase(lines.begin());
    answers.push_back({line.id, !busy});
    if (busy) {
      if (line.asked >= 0) commands[static_cast<std::size_t>(line.asked)].over = true;
      return;
    }
    if (line.command == "stop") {
      owed = false;
      for (Heartbeat& heartbeat : heartbeats) heartbeat.stopped_since_beat = true;
    }
  }
  void answer_arrives() {
    const Answer answer = answers.front();
    answers.erase(answers.begin());
    Json line{{"id", answer.id}, {"ok", answer.accepted}};
    if (!answer.accepted) line["error"] = {{"code", "busy"}};
    gateway->on_daemon_line(line, now);
  }
  void daemon_says_state() {
    static const Json state =
        Json::parse(R"({"id": 2, "watch": {"state": "idle", "result": "-", "fault": null,
      "sequence": null, "channels": []}})");
    gateway->on_daemon_line(state, now);
  }

  void gateway_dies() {
    gateway.emplace(*settings);
    for (Command& command : commands) command.over = command.over || command.executed;
    wires.clear();
    waiting.reset();
    // The requests that the dead gateway has sent reach the daemon before the requests of the new gateway.
    // The replies of the daemon to the dead gateway are lost.
    answers.clear();
    for (Plc& master : masters) master.heard = 0;
    owed = false;
    heartbeats = {};
    if (runs) {
      gateway->on_daemon_connected(now);
      carry({});
    }
  }
  void pass() {
    now += step;
    if (runs && !paused) daemon_says_state();
    for (Heartbeat& heartbeat : heartbeats) {
      if (heartbeat.watched && ++heartbeat.steps == silent_steps)
        owed = owed || !heartbeat.stopped_since_beat;
      heartbeat.steps = std::min(heartbeat.steps, silent_steps);
    }
    turn();
  }

  [[nodiscard]] std::string key() const;
  /// Returns a defect that remains even if no later failure occurs, or "" if there is no defect. There are
  /// two possible defects: the stop for a silent master is lost, or the first master can never execute a
  /// command again.
  [[nodiscard]] std::string lost_for_good() const;
};

class Key {
 public:
  Key() { bytes_.reserve(1024); }
  Key& operator<<(std::int64_t value) {
    const auto kept = static_cast<std::int32_t>(value);
    if (kept != value) throw std::out_of_range("a value of the state has more than 32 bits");
    std::array<char, sizeof kept> bytes;
    std::memcpy(bytes.data(), &kept, sizeof kept);
    bytes_.append(bytes.data(), bytes.size());
    return *this;
  }
  Key& operator<<(const std::optional<std::uint16_t>& value) { return *this << (value ? *value : -1); }
  Key& operator<<(const Frame& frame) {
    for (const std::uint16_t word : frame.words) *this << word;
    return *this << frame.command;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

/// Returns bytes that contain all parts of the state on which the later actions depend. They contain times
/// relative to the present time, in steps. They contain the rank of each id in place of the id.
std::string World::key() const {
  Key key;
  const Handshake& handshake = gateway->handshake();
  key << static_cast<int>(handshake.outcome()) << static_cast<int>(handshake.reason());
  for (const auto& entry : {handshake.done(), handshake.executing(), handshake.waiting()}) {
    key << entry.has_value();
    if (entry) key << entry->counter << entry->command.code << static_cast<int>(entry->refusal);
  }
  std::vector<ClientConnections::Id> ids;
  std::vector<Nanoseconds> asked;
  for (const auto& [id, master] : gateway->connections().all()) {
    ids.push_back(id);
    asked.push_back(master.last_request_at);
  }
  std::sort(asked.begin(), asked.end());
  const auto place = [&](const auto& in, auto value) {
    return std::find(in.begin(), in.end(), value) - in.begin();
  };
  for (const auto& [id, master] : gateway->connections().all()) {
    key << master.has_requested << master.partial_request << master.start_blocked
        << place(asked, master.last_request_at) << (now - master.last_request_at >= step);
    for (const std::uint16_t word : master.registers) key << word;
    key << master.heartbeat << master.cursor.at << master.cursor.refused;
  }
  for (const auto& [address, past] : gateway->connections().history())
    key << (address == "10.0.0.1") << past.at << past.heartbeat;
  const HeartbeatMonitor& monitor = gateway->heartbeat_monitor();
  for (const auto& [address, heartbeat] : monitor.watched()) {
    for (const Nanoseconds at : {now, now + step})
      key << (address == "10.0.0.1") << (monitor.state_of(address, at) == HeartbeatMonitor::State::silent);
  }
  key << static_cast<int>(monitor.watched().size()) << monitor.stop_required()
      << gateway->daemon_responds(now) << gateway->reaction_pending() << gateway->reaction_covers_silence()
      << (reacted_at == now);
  for (const std::uint16_t counter : gateway->pending_counters()) key << counter;
  for (const Plc& master : masters)
    key << place(ids, master.answered_on) << master.alive << static_cast<int>(master.progress)
        << master.counter << master.code << master.command << master.heartbeat << master.heard;
  for (const Wire& wire : wires) {
    key << static_cast<int>(wire.plc) << place(ids, wire.id) << wire.half << wire.heartbeat
        << wire.flying.has_value();
    if (wire.flying) key << *wire.flying << (wire.flying->halts == halts);
  }
  for (const Command& command : commands)
    key << command.code << command.counter << command.executed << command.over << command.reported_refused;
  key << runs << paused << static_cast<int>(lines.size());
  for (const Line& line : lines) key << line.command.front() << line.asked;
  for (const Answer& answer : answers) key << answer.accepted;
  key << waiting.has_value();
  if (waiting) key << *waiting << (waiting->halts == halts);
  key << owed;
  for (const Heartbeat& heartbeat : heartbeats)
    key << heartbeat.watched << heartbeat.stopped_since_beat << heartbeat.steps;
  for (std::size_t plc = 0; plc < plcs; ++plc) key << left.commands[plc] << left.connections[plc];
  key << left.master_deaths << left.gateway_deaths << left.daemon_deaths << left.pauses << left.busy;
  return key.bytes();
}

std::string World::lost_for_good() const {
  World world = *this;
  world.left.time = true;
  const auto settle = [&world] {
    for (int i = 0; i < 4; ++i) {
      world.now += Gateway::max_update_period;
      while (!world.lines.empty()) world.daemon_takes(false);
      while (!world.answers.empty()) world.answer_arrives();
      world.daemon_says_state();
      world.turn();
    }
  };
  if (!world.runs) world.daemon_starts();
  world.paused = false;
  settle();
  if (world.owed || world.gateway->heartbeat_monitor().stop_required())
    return "the reaction to a silent master is lost";
  // The programs of all masters stop, but their connections repeat the last blocks.
  for (Plc& master : world.masters) master.alive = false;
  for (int i = 0; i < 2 * silent_steps; ++i) {
    for (std::size_t wire = 0; wire < world.wires.size(); ++wire) {
      if (!world.wires[wire].flying) world.write_on(world.wires[wire]);
      world.deliver(wire);
    }
    world.pass();
    settle();
  }
  if (world.owed || world.gateway->heartbeat_monitor().stop_required())
    return "the reaction to a silent master is lost";
  if (!world.broken.empty()) return world.broken;

  if (!world.connect(0)) return "a master cannot connect: all connections are in use";
  const ClientConnections::Id id = world.wires.back().id;
  Plc& master = world.masters[0];
  master.alive = true;
  master.progress = Progress::begins;
  for (const std::uint16_t code : {std::uint16_t{0}, vent, start}) {
    if (code == 0) {
      world.look(0);
    } else {
      world.ask(0, code);
    }
    world.write(0);
    world.deliver(world.wires.size() - 1);
    settle();
    const auto [done, outcome, reason] = world.read(id);
    if (code != 0 && (done != master.counter || static_cast<Outcome>(outcome) != Outcome::accepted))
      return "a master is permanently refused with the outcome " + std::to_string(outcome) + ", reason " +
             std::to_string(reason);
  }
  return world.broken;
}

struct Step {
  const char* who;
  const char* what;
  std::function<void(World&)> take;

  [[nodiscard]] std::string name() const { return std::string(who) + what; }
};

/// Returns the actions that are possible in a given state.
std::vector<Step> steps_from(World& world) {
  constexpr std::array connection_names{"on connection 0, ", "on connection 1, "};
  static_assert(connection_names.size() == plcs, "the gateway permits one connection per master");
  std::vector<Step> steps;
  const auto add = [&](bool possible, const char* who, const char* what, auto take) {
    if (possible) steps.push_back({who, what, take});
  };
  for (std::size_t plc = 0; plc < plcs; ++plc) {
    const char* const who = plc == 0 ? "the first master " : "the second master ";
    const Plc& master = world.masters[plc];
    const Wire* const wire = world.wire_of(plc);
    const bool free = wire != nullptr && !wire->flying;
    add(world.left.connections[plc] > 0 && master.alive, who, "connects", [=](World& w) {
      --w.left.connections[plc];
      w.connect(plc);
    });
    add(free && master.progress != Progress::begins, who, "writes its block",
        [=](World& w) { w.write(plc); });
    const bool answered = free && (master.progress == Progress::begins || master.answered_on == wire->id);
    add(answered && master.alive, who, "reads the outcome of its command", [=](World& w) { w.look(plc); });
    const bool ready = master.progress == Progress::ready;
    for (const std::uint16_t code : {start, vent}) {
      add(master.alive && world.left.commands[plc] > 0 &&
              (ready || (master.progress == Progress::waits && (code == vent || world.left.impatient))),
          who, code == start ? "requests a start" : "requests a vent", [=](World& w) {
            --w.left.commands[plc];
            w.ask(plc, code);
          });
    }
    add(world.left.master_deaths > 0 && master.alive, who, "dies", [=](World& w) {
      --w.left.master_deaths;
      w.masters[plc].alive = false;
    });
  }
  for (std::size_t i = 0; i < world.wires.size(); ++i) {
    const char* const which = connection_names.at(i);
    add(world.wires[i].flying.has_value(), which, "a block arrives", [=](World& w) { w.deliver(i); });
    add(world.wires[i].flying && !world.wires[i].half, which, "half of a block arrives",
        [=](World& w) { w.deliver_half(w.wires[i]); });
  }
  add(true, "the gateway ", "runs one turn", [](World& w) { w.turn(); });
  add(world.left.time, "time ", "passes", [](World& w) { w.pass(); });
  add(world.left.gateway_deaths > 0, "the gateway ", "dies and restarts", [](World& w) {
    --w.left.gateway_deaths;
    w.gateway_dies();
  });
  add(!world.runs, "a daemon ", "starts", [](World& w) { w.daemon_starts(); });
  add(world.runs && world.left.daemon_deaths > 0, "the daemon ", "dies", [](World& w) {
    --w.left.daemon_deaths;
    w.daemon_dies();
  });
  add(world.runs && !world.paused && world.left.pauses > 0, "the daemon ", "is paused", [](World& w) {
    --w.left.pauses;
    w.paused = true;
  });
  add(world.paused, "the daemon ", "continues", [](World& w) { w.paused = false; });
  const bool hears = world.runs && !world.paused && !world.lines.empty();
  add(hears, "the daemon ", "executes the command", [](World& w) { w.daemon_takes(false); });
  add(hears && world.left.busy > 0, "the daemon ", "is busy", [](World& w) {
    --w.left.busy;
    w.daemon_takes(true);
  });
  add(!world.answers.empty(), "the daemon's ", "answer arrives", [](World& w) { w.answer_arrives(); });
  return steps;
}

struct Found {
  std::string broken;
  std::size_t states = 0;
  std::size_t steps = 0;
};

Found search(const Budget& budget) {
  const Settings settings = settings_of_the_search();
  World first(settings);
  first.left = budget;
  first.daemon_starts();
  struct Reached {
    std::size_t from;
    std::string by;
  };
  std::vector<Reached> reached{{0, ""}};
  std::deque<std::pair<World, std::size_t>> open;
  open.emplace_back(first, 0);
  std::unordered_set<std::string> seen{first.key()};
  Found found;
  const auto told = [&](std::string broken, std::size_t last, const std::string& by) {
    std::vector<std::string> path{by};
    for (std::size_t at = last; at != 0; at = reached[at].from) path.push_back(reached[at].by);
    for (auto word = path.rbegin(); word != path.rend(); ++word) broken += "\n  " + *word;
    return broken;
  };
  while (!open.empty()) {
    auto [from, index] = std::move(open.front());
    open.pop_front();
    for (const Step& taken : steps_from(from)) {
      World to = from;
      taken.take(to);
      ++found.steps;
      if (to.broken.empty() && !seen.insert(to.key()).second) continue;
      if (to.broken.empty()) to.broken = to.lost_for_good();
      if (!to.broken.empty()) {
        found.broken = told(to.broken, index, taken.name());
        found.states = seen.size();
        return found;
      }
      reached.push_back({index, taken.name()});
      open.emplace_back(std::move(to), reached.size() - 1);
    }
  }
  found.states = seen.size();
  return found;
}

void expect_nothing_broken(const Budget& budget) {
  const Found found = search(budget);
  std::printf("%zu states, %zu steps\n", found.states, found.steps);
  EXPECT_EQ(found.broken, "");
  EXPECT_GT(found.states, 1000U);
}

TEST(HandshakeSearch, NoViolationWithOneClientOnTwoConnections) {
  expect_nothing_broken({.commands = {3, 0}, .connections = {2, 0}, .busy = 1});
}

TEST(HandshakeSearch, NoViolationWithTwoClients) {
  expect_nothing_broken({.commands = {2, 1}, .connections = {1, 1}});
}

TEST(HandshakeSearch, NoViolationIfTheGatewayRestarts) {
  expect_nothing_broken({.commands = {1, 0}, .connections = {2, 1}, .gateway_deaths = 1});
}

TEST(HandshakeSearch, NoViolationWithASilentClientAndADaemonRestart) {
  expect_nothing_broken({.commands = {1, 0}, .connections = {1, 0}, .daemon_deaths = 1, .time = true});
}

TEST(HandshakeSearch, NoViolationWithASilentClientAndAPausedDaemon) {
  expect_nothing_broken({.commands = {1, 0}, .connections = {1, 0}, .pauses = 1, .time = true});
}

TEST(HandshakeSearch, NoViolationWithASilentClientAndABusyDaemon) {
  expect_nothing_broken({.commands = {1, 0}, .connections = {1, 0}, .busy = 1, .time = true});
}

TEST(HandshakeSearch, NoViolationWithASilentClientThatDoesNotWaitForReplies) {
  expect_nothing_broken({.commands = {2, 0}, .connections = {1, 0}, .impatient = true, .time = true});
}

TEST(HandshakeSearch, NoViolationWithTwoSilentClients) {
  expect_nothing_broken({.connections = {1, 1}, .master_deaths = 1, .time = true});
}

}  // namespace
}  // namespace softgrip::plc::handshake_search_test
