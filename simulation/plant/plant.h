#pragma once
// Simulates one finger: valve, actuator, load and sensor of a model, an object that the finger can touch, and
// faults. Both the simulated board and the emulator use this simulation.
// Declares the keys of the faults of a finger. The events of a rig file and the faults file of the emulator
// have the same keys with the same limits.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/enum_table.h"
#include "document/schema.h"
#include "model/model.h"

namespace softgrip::simulation {

/// An object between the fingers. After contact at `position_mm`, the finger moves by the motion without an
/// object, multiplied by `yielding`.
struct PlantObject {
  double position_mm = 0;
  double yielding = 0.1;  ///< ratio of the motion beyond the contact to the motion without an object: 0
                          ///< (rigid object) to 1 (object without effect)

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
  double share = 0;  ///< for leaking: share of the command that is lost, 0 to 1
};
/// Names of the kinds in rig files.
inline constexpr auto line_fault_names = enum_names<LineFault::Kind>({{LineFault::Kind::none, "free"},
                                                                      {LineFault::Kind::blocked, "blocked"},
                                                                      {LineFault::Kind::leaking, "leaking"}});

/// A fault of the displacement sensor.
struct SensorFault {
  enum class Kind : std::uint8_t {
    none,
    stuck,         ///< the sensor repeats its last value
    offset,        ///< value_mm is added to each reading
    out_of_range,  ///< the sensor has no valid reading; the board shows its error value or an electrical
                   ///< limit
  };
  Kind kind = Kind::none;
  double value_mm = 0;
};
/// Names of the kinds in rig files.
inline constexpr auto sensor_fault_names =
    enum_names<SensorFault::Kind>({{SensorFault::Kind::none, "good"},
                                   {SensorFault::Kind::stuck, "stuck"},
                                   {SensorFault::Kind::offset, "offset"},
                                   {SensorFault::Kind::out_of_range, "out_of_range"}});

struct PlantSettings {
  model::Model model;
  std::optional<PlantObject> object;  ///< object that is present at the start; empty: no object
  double sample_time_s = 0;           ///< usual duration of a call of advance() [s]; 0: the durations are
                                      ///< irregular
  double displacement_noise_mm = 0;   ///< standard deviation of the noise that is added to the output of the
                                      ///< model's sensor blocks
  double pressure_noise_kpa = 0;      ///< standard deviation of the noise of the measured pressure
  double temperature_c = 20;          ///< ambient temperature of the finger
  double temperature_noise_c = 0;     ///< standard deviation of the noise of the measured temperature
  std::uint64_t seed = 0;
};

/// Simulates a finger over time. The command is constant between two calls of command(), because a board
/// holds its output. If sample_time_s is above 0, advance() allocates no memory.
class Plant {
 public:
  /// Creates a finger at rest under the command 0 kPa. The model in `settings` must be valid.
  explicit Plant(const PlantSettings& settings);
  Plant(const Plant&) = delete;
  Plant& operator=(const Plant&) = delete;
  Plant(Plant&&) noexcept;
  Plant& operator=(Plant&&) noexcept;
  ~Plant();

  /// Sets the command, which is the output of the board [kPa]. A value that is not finite is ignored.
  void command(double command_kpa) noexcept;
  /// Advances the simulation by `duration_s` >= 0. The command is constant during this time.
  void advance(double duration_s) noexcept;

  [[nodiscard]] double held_command_kpa() const noexcept;
  /// Returns the sensor reading with noise and faults [mm]. The reading is not valid while sees_nothing()
  /// returns true.
  [[nodiscard]] double reading_mm() const noexcept;
  /// Returns the true displacement of the finger, without errors of the sensor [mm].
  [[nodiscard]] double displacement_mm() const noexcept;
  /// Returns the reading of a pressure monitor [kPa], with noise.
  [[nodiscard]] double measured_pressure_kpa() const noexcept;
  /// Returns the true pressure [kPa], without noise.
  [[nodiscard]] double pressure_kpa() const noexcept;
  /// Returns the reading of a temperature sensor [degC], with noise.
  [[nodiscard]] double measured_temperature_c() const noexcept;
  /// Returns true while the sensor has the fault out_of_range. In this case, reading_mm() is not valid.
  [[nodiscard]] bool sees_nothing() const noexcept;

  /// Places the object `object`, or removes the present object if `object` is empty. The effect on the finger
  /// begins with the next advance().
  void set_object(const std::optional<PlantObject>& object) noexcept;
  [[nodiscard]] const std::optional<PlantObject>& object() const noexcept;
  void set_fault(const LineFault& fault) noexcept;
  void set_fault(const SensorFault& fault) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

inline constexpr document::Range reach_mm{-1000, 1000};

/// Returns the key of a leak, which the line fault `leaking` requires.
[[nodiscard]] inline document::Key<LineFault> leak_key() {
  return document::required("share", &LineFault::share, {0, 1},
                            "share of the commanded pressure that is lost");
}
/// Returns the key with the name `name` for the size of an offset [mm], which the sensor fault `offset`
/// requires.
[[nodiscard]] inline document::Key<SensorFault> offset_key(std::string name) {
  return document::required(std::move(name), &SensorFault::value_mm, reach_mm, "offset of the reading");
}
/// Reads an object with the keys `position_mm` and `yielding`.
[[nodiscard]] inline PlantObject read_object(const document::Document& document, const document::Node& node,
                                             document::Problems& problems) {
  document::MapReader reader(document, node, problems, "object");
  PlantObject object;
  object.position_mm = reader.number("position_mm", reach_mm);
  object.yielding = reader.number("yielding", {0, 1});
  return object;
}

}  // namespace softgrip::simulation
