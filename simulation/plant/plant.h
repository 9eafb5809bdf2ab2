#pragma once
// Simulates one finger: valve, actuator, load and sensor of a model, an optional object in its way, and
// faults. The simulated board and the emulator use the same plant.

#include <cstdint>
#include <memory>
#include <optional>

#include "model/model.h"

namespace softgrip::simulation {

/// Something between the fingers. Beyond `position_mm` the finger moves only `yielding` times as far as it
/// would without it.
struct PlantObject {
  double position_mm = 0;
  double yielding = 0.1;  ///< 0 (rigid) to 1 (nothing there)

  bool operator==(const PlantObject&) const = default;
};

/// A fault of the pneumatic line.
struct LineFault {
  enum class Kind : std::uint8_t {
    none,
    blocked,  ///< commands have no effect any more: the finger stays at the pressure it has
    leaking,  ///< a share of every command is lost
  };
  Kind kind = Kind::none;
  double share = 0;  ///< leaking: 0 to 1
};

/// A fault of the displacement sensor.
struct SensorFault {
  enum class Kind : std::uint8_t {
    none,
    stuck,         ///< repeats its last value
    offset,        ///< off by value_mm: a sensor that jumped
    out_of_range,  ///< sees nothing; the board shows its error value or an electrical end
  };
  Kind kind = Kind::none;
  double value_mm = 0;
};

struct PlantSettings {
  model::Model model;
  std::optional<PlantObject> object;  ///< there from the start
  double sample_time_s = 0;           ///< usual duration of advance(), 0 if irregular
  double displacement_noise_mm = 0;   ///< standard deviation, besides the model's own sensor blocks
  double pressure_noise_kpa = 0;      ///< of the measured pressure
  double temperature_c = 20;          ///< of the finger's surroundings
  double temperature_noise_c = 0;     ///< of the measured temperature
  std::uint64_t seed = 0;
};

/// A finger that moves in time. The command is held between changes, as a board's output holds it.
/// advance() allocates nothing when sample_time_s is above 0.
class Plant {
 public:
  /// At rest, command 0. The model must be valid.
  explicit Plant(const PlantSettings& settings);
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;
  Plant(Plant&&) noexcept;
  Plant& operator=(Plant&&) noexcept;
  ~Plant();

  /// The output of the board from now on [kPa]. Not finite: ignored.
  void command(double command_kpa) noexcept;
  /// Moves on by `duration_s` >= 0 under the held command.
  void advance(double duration_s) noexcept;

  [[nodiscard]] double held_command_kpa() const noexcept;
  /// Returns the sensor reading [mm], with noise and faults; see sees_nothing().
  [[nodiscard]] double reading_mm() const noexcept;
  /// Returns the true displacement of the finger [mm], without the sensor.
  [[nodiscard]] double displacement_mm() const noexcept;
  /// Returns the reading of a pressure monitor [kPa], with noise.
  [[nodiscard]] double measured_pressure_kpa() const noexcept;
  /// Without noise.
  [[nodiscard]] double pressure_kpa() const noexcept;
  /// Returns the reading of a temperature sensor, with noise.
  [[nodiscard]] double measured_temperature_c() const noexcept;
  /// True while the sensor is out of range: reading_mm() means nothing.
  [[nodiscard]] bool sees_nothing() const noexcept;

  /// Puts an object there, or takes it away. The finger follows with the next advance().
  void set_object(const std::optional<PlantObject>& object) noexcept;
  [[nodiscard]] const std::optional<PlantObject>& object() const noexcept;
  void set_fault(const LineFault& fault) noexcept;
  void set_fault(const SensorFault& fault) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip::simulation
