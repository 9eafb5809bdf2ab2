#pragma once
// The board and the fingers behind it, as they are: outputs, a watchdog of its own, slow air. Whoever is
// connected may write; the line may lose what is said.

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "drivers/board/board.h"
#include "simulation/plant/plant.h"
#include "tests/world/scheduler.h"

namespace softgrip::world {

struct HardwareSettings {
  std::vector<simulation::PlantSettings> plants;
  std::vector<double> safe_kpa;  ///< one per plant: what the board puts out at first, and its watchdog
  Nanoseconds watchdog = 0;      ///< outputs go to safe_kpa after so long without a request; 0: none
  bool trip_latches = true;      ///< writes are refused until the next connection; else the next one is taken
  Nanoseconds plant_step = 0;    ///< how often outputs reach the air
  std::function<void()> on_trip;  ///< the watchdog has vented
};

class Hardware {
 public:
  explicit Hardware(HardwareSettings settings);

  void move_to(Nanoseconds now);
  /// A session was opened: a latched trip is over.
  void greet(Nanoseconds now);
  /// What is written now does not count: a latched trip refuses it, or the outputs do not follow.
  [[nodiscard]] bool ignores_writes() const noexcept {
    return refuses_writes || (tripped_ && settings_.trip_latches);
  }
  /// False while a latched trip refuses it.
  bool write(Nanoseconds now, std::span<const double> outputs_kpa);
  void read(std::size_t channel, Nanoseconds now, model::Reading& reading) const;

  [[nodiscard]] std::span<const double> outputs_kpa() const noexcept { return outputs_kpa_; }
  [[nodiscard]] std::size_t channels() const noexcept { return outputs_kpa_.size(); }
  [[nodiscard]] Nanoseconds watchdog() const noexcept { return settings_.watchdog; }
  [[nodiscard]] simulation::Plant& plant(std::size_t channel) { return plants_[channel]; }
  bool refuses_writes = false;
  std::uint64_t foreign_writes = 0;  ///< by another master

 private:
  void advance_plants(Nanoseconds until);
  void put_out();

  HardwareSettings settings_;
  std::vector<simulation::Plant> plants_;
  std::vector<double> outputs_kpa_;
  Nanoseconds plants_at_ = 0;
  Nanoseconds fed_at_ = 0;
  bool begun_ = false;
  bool tripped_ = false;
};

/// Habits of a board, and the keys of the rig file and the board map for them. A number of 0 disables one.
struct Habits {
  Nanoseconds deaf = 0;              ///< the time after a connection in which it ignores requests
  Nanoseconds settle = 0;            ///< `settle_s`: the wait after a connection
  Nanoseconds repeat_after = 0;      ///< `repeat_after_s`: a request without a response is sent again
  std::size_t channels_at_once = 0;  ///< `max_registers`: the channels that one request writes
  unsigned closes_every = 0;         ///< every Nth connection is closed at once
  unsigned loses_every = 0;          ///< every Nth response is lost
  unsigned spoils_every = 0;         ///< every Nth exchange has more stray bytes than are discarded
  bool reads_apart = false;          ///< one request writes, and another one reads (no function code 23)
};

/// What is between daemon and board.
struct Line {
  drivers::BusStatus status = drivers::BusStatus::ok;
  bool reply_lost = false;  ///< with timed_out: the request arrives, only the reply does not
  Nanoseconds latency = 800'000;
};

/// The board as a daemon sees it. It waits on the world's clock. What was sent arrives whether the daemon
/// goes on or stands still: an actor of its own carries it.
class WorldBoard final : public drivers::Board {
 public:
  /// Told before a request takes effect: when the exchange began, and what it writes.
  using OnWrite = std::function<void(Nanoseconds began, std::span<const double> commands_kpa)>;

  struct Callbacks {
    OnWrite on_write;
    std::function<void()> on_exchange;  ///< when an exchange begins
    std::function<void()> on_hindered;  ///< when a habit has made an exchange fail
    /// When the daemon has read the outputs as they were after this number of writes of another master.
    std::function<void(std::uint64_t foreign_writes)> on_read;
  };
  WorldBoard(Hardware& hardware, Habits habits, Line& line, Scheduler& scheduler, Callbacks callbacks);

  /// Who spoke is gone: what is on its way is lost.
  void hang_up() noexcept { request_.reset(); }

  [[nodiscard]] std::size_t channels() const noexcept override { return hardware_.channels(); }
  [[nodiscard]] drivers::BusStatus connect(std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] drivers::BusStatus exchange(std::span<const double> commands_kpa,
                                            std::span<model::Reading> readings,
                                            std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] double found_kpa(std::size_t channel) const noexcept override { return found_[channel]; }
  [[nodiscard]] std::string describe() const override { return "a board in the world"; }
  [[nodiscard]] Budget budget() const override { return {}; }
  [[nodiscard]] bool has_watchdog() const noexcept override { return hardware_.watchdog() > 0; }
  [[nodiscard]] std::chrono::nanoseconds watchdog_time() const noexcept override {
    return std::chrono::nanoseconds(hardware_.watchdog());
  }

 private:
  /// What is on its way to the board, and then back.
  struct Request {
    Nanoseconds began = 0;
    Nanoseconds arrives = 0;
    std::vector<double> sent;
    std::size_t first = 0, count = 0;  ///< the channels that it writes
    bool again = false;                ///< it is sent a second time
    bool there = false;
    bool ignored = false;
    bool taken = false;
    bool overwritten = false;          ///< it read before it wrote, and found what nobody here had written
    std::uint64_t foreign_writes = 0;  ///< by another master, before it read
    std::vector<model::Reading> read;
  };
  void pass(Nanoseconds duration) { scheduler_.sleep_until(scheduler_.now() + duration); }
  [[nodiscard]] bool ask(Request request, Nanoseconds end, bool lost);
  [[nodiscard]] bool lost_by_habit() noexcept {
    return habits_.loses_every > 0 && ++responses_ % habits_.loses_every == 0;
  }
  [[nodiscard]] drivers::BusStatus hindered(drivers::BusStatus status);
  void carry();

  Hardware& hardware_;
  Habits habits_;
  Line& line_;
  Scheduler& scheduler_;
  Callbacks callbacks_;
  ActorId carrier_;
  std::optional<Request> request_;
  std::vector<double> found_;  // where the newest reading is not as written, else NaN
  std::vector<double> left_;   // what the last good exchange of this session left at the outputs
  unsigned exchanges_ = 0;
  unsigned connections_ = 0, responses_ = 0, answers_ = 0;
  bool closes_ = false;  // the present connection
  Nanoseconds opened_at_ = 0;
};

}  // namespace softgrip::world
