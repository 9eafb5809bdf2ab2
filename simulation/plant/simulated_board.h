#pragma once
// The rig in process: N plants behind the board interface. Deterministic: the same settings, the same clock
// readings and the same commands give the same bits.

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

/// Something that happens at a scripted time.
struct SimulatedEvent {
  enum class Kind : std::uint8_t {
    object,         ///< places `object` in the way of the finger; none: removes it
    line_fault,     ///< `line`
    sensor_fault,   ///< `sensor`
    bus_lost,       ///< every exchange ends with `status`; while that is `disconnected`, connect() fails too
    bus_restored,   ///< exchanges work again, after a connect() if the status was one that ends the session
    write_refused,  ///< outputs keep their value; an exchange with a new value reports it
    write_taken,    ///< outputs follow again
  };
  /// All channels.
  static constexpr std::size_t every_channel = static_cast<std::size_t>(-1);

  double at_s = 0;  ///< since the first exchange
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
  double valve_min_kpa = 0;  ///< lowest output, below 0 for vacuum
  double valve_max_kpa = 0;  ///< full scale of the output, above the lowest; commands outside are refused
  double vented_kpa = 0;     ///< what the watchdog puts out
  double sensor_min_mm = 0;  ///< measuring range of the sensor; beyond it readings are out of range
  double sensor_max_mm = 0;
  int output_bits = 0;  ///< over the output's range; 0: not quantised
  int input_bits = 0;   ///< over the measuring range, and over the output's for pressure; 0: not quantised
};

struct SimulatedBoardSettings {
  std::vector<SimulatedChannel> channels;
  std::vector<SimulatedEvent> events;  ///< in any order
  /// Time without an exchange after which the outputs go to `vented_kpa` [s]; they stay there until
  /// connect(). 0: no watchdog.
  double watchdog_timeout_s = 0;
};

/// An exchange at time t: the plants move on to t under the commands held so far, the readings are taken,
/// then the new commands are applied. The reading of an exchange thus never knows the command written in it.
class SimulatedBoard final : public drivers::Board {
 public:
  /// `clock` outlives the board.
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

  /// The plant of a channel, to be poked by tests and by scripts at run time (from the exchanging thread).
  [[nodiscard]] Plant& plant(std::size_t channel);
  /// Lets something happen now.
  void happen(const SimulatedEvent& event) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip::simulation
