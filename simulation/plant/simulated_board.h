#pragma once
// Simulates a rig in this process: a board to which several plants are connected. The simulation is
// deterministic: equal settings, clock readings and commands give bit-identical results.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/clock.h"
#include "drivers/board/board.h"
#include "simulation/plant/plant.h"

namespace softgrip::simulation {

/// An event at a scripted time.
struct SimulatedEvent {
  enum class Kind : std::uint8_t {
    object,         ///< places `object` in the path of the finger; nullopt: removes it
    line_fault,     ///< sets the fault `line`
    sensor_fault,   ///< sets the fault `sensor`
    bus_lost,       ///< every exchange returns `status`; if it is `disconnected`, connect() also fails
    bus_restored,   ///< exchanges succeed again; if `status` ended the session, only after connect()
    write_refused,  ///< outputs keep their values; an exchange with a new value reports the refusal
    write_taken,    ///< outputs follow commands again
  };
  /// Value of `channel` for an event that applies to all channels.
  static constexpr std::size_t every_channel = static_cast<std::size_t>(-1);

  double at_s = 0;  ///< time since the first exchange
  Kind kind = Kind::object;
  std::size_t channel = every_channel;
  std::optional<PlantObject> object = std::nullopt;
  LineFault line = {};
  SensorFault sensor = {};
  drivers::BusStatus status = drivers::BusStatus::disconnected;
};

struct SimulatedChannel {
  std::string name;
  PlantSettings plant;
  bool measures_pressure = false;
  bool measures_temperature = false;
  double valve_min_kpa = 0;  ///< lowest output; below 0 for vacuum
  double valve_max_kpa = 0;  ///< highest output; commands outside the range are limited and reported
  double vented_kpa = 0;     ///< output after a watchdog trip
  double sensor_min_mm = 0;  ///< lower end of the measuring range; readings outside it are not valid
  double sensor_max_mm = 0;
  int output_bits = 0;  ///< resolution over the output range; 0: not quantised
  int input_bits = 0;   ///< resolution over the measuring range and over the pressure range; 0: not quantised
};

struct SimulatedBoardSettings {
  std::vector<SimulatedChannel> channels;
  std::vector<SimulatedEvent> events;  ///< events in any order
  /// Time without an exchange after which the outputs change to `vented_kpa` [s]. They keep this value until
  /// connect(). 0: no watchdog.
  double watchdog_timeout_s = 0;
};

/// An exchange at time t first advances the plants to t with the previous commands. The new commands have an
/// effect only after t. A measured value therefore never depends on the command of the same exchange.
class SimulatedBoard final : public drivers::Board {
 public:
  /// `clock` must outlive the board.
  SimulatedBoard(const SimulatedBoardSettings& settings, const Clock& clock);
  ~SimulatedBoard() override;

  [[nodiscard]] std::size_t channels() const noexcept override;
  [[nodiscard]] drivers::BusStatus connect(std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] drivers::BusStatus exchange(std::span<const double> commands_kpa,
                                            std::span<model::Reading> readings,
                                            std::chrono::nanoseconds deadline) noexcept override;
  [[nodiscard]] const char* detail() const noexcept override;
  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] Budget budget() const override;
  [[nodiscard]] bool has_watchdog() const noexcept override;
  [[nodiscard]] std::chrono::nanoseconds watchdog_time() const noexcept override;

  /// Returns the plant of a channel, so that tests and scripts can change it. Only the thread that calls
  /// exchange() may use it.
  [[nodiscard]] Plant& plant(std::size_t channel);
  /// Applies an event now.
  void happen(const SimulatedEvent& event) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip::simulation
