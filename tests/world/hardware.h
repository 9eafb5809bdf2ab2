#pragma once
// Simulates the board and its fingers: outputs, watchdog of the board, and slow pneumatics. Every Modbus
// client may write. The line may lose requests and responses.

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
  std::vector<double> safe_kpa;   ///< output of each channel at power-up and after a watchdog trip [kPa]
  Nanoseconds watchdog = 0;       ///< time after the last request at which the outputs change to safe_kpa; 0:
                                  ///< no watchdog
  bool trip_latches = true;       ///< true: after a trip, the board refuses writes until a client connects
  Nanoseconds plant_step = 0;     ///< interval at which written outputs take effect [ns]
  std::function<void()> on_trip;  ///< function to call after the watchdog has vented the outputs
};

class Hardware {
 public:
  explicit Hardware(HardwareSettings settings);

  void move_to(Nanoseconds now);
  /// Called when a client connects to the board. Clears a latched watchdog trip.
  void greet(Nanoseconds now);
  /// Returns true if a write to the board has no effect. Either a latched trip refuses the write, or the
  /// outputs do not follow.
  [[nodiscard]] bool ignores_writes() const noexcept {
    return refuses_writes || (tripped_ && settings_.trip_latches);
  }
  /// Writes the outputs. Returns false if a latched watchdog trip refuses the write.
  bool write(Nanoseconds now, std::span<const double> outputs_kpa);
  void read(std::size_t channel, Nanoseconds now, model::Reading& reading) const;

  [[nodiscard]] std::span<const double> outputs_kpa() const noexcept { return outputs_kpa_; }
  [[nodiscard]] std::size_t channels() const noexcept { return outputs_kpa_.size(); }
  [[nodiscard]] Nanoseconds watchdog() const noexcept { return settings_.watchdog; }
  [[nodiscard]] simulation::Plant& plant(std::size_t channel) { return plants_[channel]; }
  bool refuses_writes = false;
  std::uint64_t foreign_writes = 0;  ///< number of writes by another Modbus client

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

/// Unusual properties of a board, and the values of the rig file and the board file that compensate for these
/// properties. The value 0 disables a property.
struct Habits {
  Nanoseconds deaf = 0;              ///< duration after a connection during which the board ignores requests
  Nanoseconds settle = 0;            ///< `settle_s` of the rig file: waiting time of the driver after a
                                     ///< connection
  Nanoseconds repeat_after = 0;      ///< `repeat_after_s`: time without a response after which the driver
                                     ///< repeats a request
  std::size_t channels_at_once = 0;  ///< `max_registers`: largest number of channels that one request writes
  unsigned closes_every = 0;         ///< the board closes every Nth connection immediately
  unsigned loses_every = 0;          ///< every Nth response of the board is lost
  unsigned spoils_every = 0;         ///< before every Nth response, more stray bytes arrive than the driver
                                     ///< discards
  bool reads_apart = false;          ///< true: separate requests write and read, because the board lacks
                                     ///< function code 23
};

/// State of the communication line between the daemon and the board.
struct Line {
  drivers::BusStatus status = drivers::BusStatus::ok;
  bool reply_lost = false;  ///< only if the status is timed_out; true: the request arrives, and the response
                            ///< is lost
  Nanoseconds latency = 800'000;
};

/// The driver of the simulated board. During an exchange, the driver waits on the simulated clock. A separate
/// simulated thread carries the requests, so that a request arrives even if the daemon is paused.
class WorldBoard final : public drivers::Board {
 public:
  /// Function to call before a request takes effect. Arguments: the start time of the exchange and the values
  /// that will be written.
  using OnWrite = std::function<void(Nanoseconds began, std::span<const double> commands_kpa)>;

  struct Callbacks {
    OnWrite on_write;
    std::function<void()> on_exchange;  ///< function to call when an exchange begins
    std::function<void()> on_hindered;  ///< function to call when an unusual property of the board has made
                                        ///< an exchange fail
    /// Called when the daemon has read the outputs. `foreign_writes` is the number of writes that another
    /// client had made before the daemon read the outputs.
    std::function<void(std::uint64_t foreign_writes)> on_read;
  };
  WorldBoard(Hardware& hardware, Habits habits, Line& line, Scheduler& scheduler, Callbacks callbacks);

  /// Called when the program that uses the board has ended. A pending request of this program is then lost.
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
  /// A request on its way to the board. After its arrival, this structure contains the response as well.
  struct Request {
    Nanoseconds began = 0;
    Nanoseconds arrives = 0;
    std::vector<double> sent;
    std::size_t first = 0, count = 0;  ///< first channel that the request writes, and number of written
                                       ///< channels
    bool again = false;                ///< true: this is a repetition of an earlier request
    bool there = false;
    bool ignored = false;
    bool taken = false;
    bool overwritten = false;  ///< true: before the write, the board had outputs that this program had not
                               ///< written
    std::uint64_t foreign_writes = 0;  ///< number of writes that another Modbus client made before the
                                       ///< outputs were read
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
  std::vector<double> found_;  // newest output of each channel if it differs from the written value,
                               // otherwise NaN
  std::vector<double> left_;   // outputs after the last successful exchange of this session; empty: unknown
  unsigned exchanges_ = 0;
  unsigned connections_ = 0, responses_ = 0, answers_ = 0;
  bool closes_ = false;  // true: the board closes the present connection before the first exchange
  Nanoseconds opened_at_ = 0;
};

}  // namespace softgrip::world
