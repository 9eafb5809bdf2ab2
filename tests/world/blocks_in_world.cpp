#include "tests/world/blocks_in_world.h"

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "tools/client/daemon_client.h"

namespace softgrip::world {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* ends_with_block = "the end of a Python block stops its sequence";
constexpr const char* stops_no_other = "the end of a Python block stops no other sequence";
constexpr std::size_t client_count = 2;
constexpr std::array block_sequences{"free_stroke", "empty_grip", "pressure_staircase", "hand_over"};
/// Interval at which a client reads the messages of the daemon.
constexpr Nanoseconds client_look_pause = ns_per_s / 50;
/// Longest time for which a client waits for the response of the daemon to its request.
constexpr Nanoseconds block_patience = 5 * ns_per_s;
/// Longest permitted time from a stop request to the end of the sequence. The time is counted again from 0
/// after a pause of the daemon and after a disturbance of the bus.
constexpr Nanoseconds block_end_bound = 2 * ns_per_s;
/// Fraction of the blocks in which the client program is killed before it sends a stop.
constexpr double killed_share = 0.1;
constexpr std::uint64_t start_line = 1;
constexpr std::uint64_t stop_line = 2;

/// A start of a sequence, and the later actions of the client that has requested this start.
struct Started {
  std::string id;
  std::uint64_t life = 0;                ///< number of the daemon run in which the client has sent the start
  std::optional<std::uint32_t> request;  ///< id that the daemon has given to the start request; nullopt: not
                                         ///< accepted yet
  bool left = false;                     ///< true: the client has sent a request that stops this start
  bool confirmed = false;                ///< true: the daemon has confirmed the request that stops this start
  bool halted = false;     ///< true: another client has sent a stop, a vent or a release after this start
  Nanoseconds waited = 0;  ///< time since the stop request, or since the last pause of the daemon or
                           ///< disturbance of the bus after it
};

class BlocksInWorld final : public Guest {
 public:
  explicit BlocksInWorld(Host& host)
      : host_(host),
        around_(host.around()),
        seed_(derived_seed(around_.shape.seed, 8)),
        loader_(std::make_shared<const daemon::SequenceLoader>(around_.shape.rig.settings,
                                                               SOFTGRIP_SOURCE_DIR "/config/sequences")) {}

  void begin() override {
    for (std::size_t i = 0; i < client_count; ++i) {
      around_.scheduler.add("client", [this] {
        for (;;) {
          sleep(0.05 + 2 * drawn());
          if (host_.daemon() != nullptr) block();
        }
      });
    }
  }
  void prepare(Life& life) override { life.loader = loader_; }
  void boots(DaemonInWorld&) override { ++life_; }
  void asked(control::Request::Kind kind) override {
    using Asked = control::Request::Kind;
    const bool halts = kind == Asked::stop || kind == Asked::vent || kind == Asked::release;
    for (Started& started : started_) started.halted = started.halted || halts;
  }

  void look(const Excuse& excuse) override {
    const Nanoseconds now = around_.scheduler.now();
    const Nanoseconds passed = seen_ == 0 ? 0 : now - seen_;
    seen_ = now;
    DaemonInWorld* const daemon = host_.daemon();
    if (daemon == nullptr || daemon->shared.shutdown_requested.load()) return;
    const bool disturbed = excuse.paused || excuse.no_line;
    for (Started& started : started_) {
      if (started.life != life_ || !started.request) continue;
      const bool runs = daemon->service.is_running(*started.request);
      if (started.left) started.waited = disturbed ? 0 : started.waited + passed;
      if (runs && started.confirmed)
        breaks(ends_with_block, "the daemon has confirmed the stop, but the sequence is still running");
      if (runs && started.waited > block_end_bound)
        breaks(ends_with_block, "the sequence is still running more than 2 s after the stop request");
      const daemon::Service::FinishedSequence& ending = daemon->service.last_finished();
      if (ending.request == *started.request && ending.end == control::SequenceEnd::stopped &&
          !started.left && !started.halted)
        breaks(stops_no_other,
               "a sequence was stopped, but no client has requested a stop, a vent or a release");
    }
  }

 private:
  [[nodiscard]] double drawn() { return uniform_at(seed_, ++drawn_); }
  void sleep(double duration_s) {
    around_.scheduler.sleep_until(around_.scheduler.now() + nanoseconds(duration_s));
  }
  void breaks(const char* invariant, const char* text) {
    around_.monitor.command_breaks(around_.scheduler.now(), invariant, text);
  }

  void block() {
    const std::uint64_t life = life_;
    const daemon::ClientId client = host_.daemon()->socket->connect();
    Started& started = started_.emplace_back();
    started.id = fmt::format("start {}", ++met().calls);
    started.life = life;
    Json line{{"id", start_line}, {"command", "start"}, {"start_id", started.id}};
    line["sequence"] = block_sequences[static_cast<std::size_t>(drawn() * block_sequences.size())];
    say(client, line);
    const bool killed = drawn() < killed_share;
    const Nanoseconds leaves =
        around_.scheduler.now() + nanoseconds(drawn() < 0.3 ? 0.2 * drawn() : 8 * drawn());
    while (around_.scheduler.now() < leaves && life == life_ && host_.daemon() != nullptr)
      hear(client, started);
    if (life != life_ || host_.daemon() == nullptr) return;
    if (!killed) leave(client, started, life);
    if (life == life_ && host_.daemon() != nullptr) host_.daemon()->socket->hang_up(client);
  }

  /// Sends the stop request immediately. Unlike other requests, it is not preceded by a status query.
  void leave(daemon::ClientId client, Started& started, std::uint64_t life) {
    Json line = tools::stop_request_for(started.id);
    line["id"] = stop_line;
    around_.trace("the client of {} leaves its block", started.id);
    started.left = true;
    say(client, line);
    const Nanoseconds give_up = around_.scheduler.now() + block_patience;
    while (around_.scheduler.now() < give_up && !started.confirmed && life == life_ &&
           host_.daemon() != nullptr)
      hear(client, started);
    met().results += started.confirmed ? 1U : 0U;
  }

  void say(daemon::ClientId client, const Json& line) {
    around_.trace("a client to the daemon: {}", line.dump());
    host_.daemon()->socket->say(client, line);
    const ActorId service = host_.daemon()->actor(Part::service);
    if (service != 0) around_.scheduler.wake(service);
  }

  void hear(daemon::ClientId client, Started& started) {
    for (const Json& line : host_.daemon()->socket->hear(client)) {
      around_.trace("the daemon about {}: {}", started.id, line.dump());
      const bool ok = line.value("ok", false);
      if (line.value("id", std::uint64_t{0}) == start_line && ok)
        started.request = line["result"]["request"].get<std::uint32_t>();
      if (line.value("id", std::uint64_t{0}) == stop_line) started.confirmed = tools::confirms_stop(line);
    }
    around_.scheduler.sleep_until(around_.scheduler.now() + client_look_pause);
  }

  Host& host_;
  Surroundings& around_;
  std::uint64_t seed_;
  std::uint64_t drawn_ = 0;
  std::shared_ptr<const daemon::SequenceLoader> loader_;
  std::uint64_t life_ = 0;  // number of the present daemon run
  std::deque<Started> started_;
  Nanoseconds seen_ = 0;
};

}  // namespace

std::unique_ptr<Guest> make_blocks(Host& host) {
  return std::make_unique<BlocksInWorld>(host);
}

}  // namespace softgrip::world
