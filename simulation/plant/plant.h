#pragma once
// Simulates one finger: valve, actuator, load and sensor of a model, an optional object in its way, and
// faults. The simulated board and the emulator use the same plant.

#include <cstdint>
#include <memory>
#include <optional>

#include "model/model.h"

namespace softgrip::simulation {

/// An object between the fingers. Beyond `position_mm`, the motion of the finger is multiplied by `yielding`.
struct PlantObject {
  double position_mm = 0;
  double yielding = 0.1;  ///< 0 (rigid) to 1 (no effect)

  bool operator==(const PlantObject&) const = default;
};

/// A fault of the pneumatic line.
struct LineFault {
  enum class Kind : std::uint8_t {
    none,
    blocked,  ///< commands have no effect; the finger keeps its pressure
    leaking,  ///< the finger receives (1 - share) of the command
  };
  Kind kind = Kind::none;
  double share = 0;  ///< lost share of the command, 0 to 1; only for leaking
};

/// A fault of the displacement sensor.
struct SensorFault {
  enum class Kind : std::uint8_t {
    none,
    stuck,         ///< repeats its last value
    offset,        ///< each reading has the offset value_mm
    out_of_range,  ///< no valid reading; the board shows its error value or an electrical limit
  };
  Kind kind = Kind::none;
  double value_mm = 0;
};

struct PlantSettings {
  model::Model model;
  std::optional<PlantObject> object;  ///< object at the start
  double sample_time_s = 0;           ///< usual duration of advance(); 0 if irregular
  double displacement_noise_mm = 0;   ///< standard deviation, in addition to the sensor blocks of the model
  double pressure_noise_kpa = 0;      ///< standard deviation of the measured pressure
  double temperature_c = 20;          ///< ambient temperature of the finger
  double temperature_noise_c = 0;     ///< standard deviation of the measured temperature
  std::uint64_t seed = 0;
};

/// Simulates a finger over time. The command is constant between changes, like an output that a board holds.
/// advance() allocates no memory if sample_time_s is above 0.
class Plant {
 public:
  /// Creates a finger at rest with the command 0 kPa. The model must be valid.
  explicit Plant(const PlantSettings& settings);
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;
  Plant(Plant&&) noexcept;
  Plant& operator=(Plant&&) noexcept;
  ~Plant();

  /// Sets the output of the board [kPa]. A value that is not finite is ignored.
  void command(double command_kpa) noexcept;
  /// Advances by `duration_s` >= 0 with a constant command.
  void advance(double duration_s) noexcept;

  [[nodiscard]] double held_command_kpa() const noexcept;
  /// Returns the sensor reading [mm], with noise and faults; see sees_nothing().
  [[nodiscard]] double reading_mm() const noexcept;
  /// Returns the true displacement of the finger [mm], without the sensor.
  [[nodiscard]] double displacement_mm() const noexcept;
  /// Returns the reading of a pressure monitor [kPa], with noise.
  [[nodiscard]] double measured_pressure_kpa() const noexcept;
  /// Returns the true pressure [kPa], without noise.
  [[nodiscard]] double pressure_kpa() const noexcept;
  /// Returns the reading of a temperature sensor [degC], with noise.
  [[nodiscard]] double measured_temperature_c() const noexcept;
  /// Returns true while the sensor has the fault out_of_range. reading_mm() is then not valid.
  [[nodiscard]] bool sees_nothing() const noexcept;

  /// Places an object. An empty value removes the object. The finger reacts at the next advance().
  void set_object(const std::optional<PlantObject>& object) noexcept;
  [[nodiscard]] const std::optional<PlantObject>& object() const noexcept;
  void set_fault(const LineFault& fault) noexcept;
  void set_fault(const SensorFault& fault) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip::simulation
