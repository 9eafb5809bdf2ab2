#pragma once
/// @file
/// Models of a finger: simulation and inverse. Stable.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <softgrip/error.h>
#include <softgrip/export.h>

namespace softgrip {

/// Unit of the displacement in a log and of the output of a model.
enum class Unit : std::uint8_t {
  mm,   ///< displacement
  deg,  ///< bending angle
};

/// Returns "mm" or "deg".
[[nodiscard]] SOFTGRIP_API std::string name_of(Unit unit);

/// One parameter of a model.
struct Parameter {
  std::string name;   ///< for example "kelvin_voigt.k1_kpa_per_mm"
  double value = 0;   ///< value in `unit`
  std::string unit;   ///< for example "kPa/mm"; empty: no unit
  double lower = 0;   ///< smallest permitted value
  double upper = 0;   ///< largest permitted value
  std::string about;  ///< description in one line
};

/// Settings of Model::simulate().
struct SimulateOptions {
  /// False: the pressure is linear between samples. True: each sample's pressure is held until the next one,
  /// as a board holds its output; the displacement of a sample does not depend on the pressure of that
  /// sample.
  bool held = false;
  double noise = 0;  ///< standard deviation of white noise on the output, in the unit of the model; >= 0
  std::uint64_t seed = 1;                      ///< seed of all noise. Equal seeds give equal bits
  std::span<const double> supply_kpa = {};     ///< supply pressure [kPa], one value per sample, or empty
  std::span<const double> temperature_c = {};  ///< temperature [degrees Celsius], one per sample, or empty
};

/// Settings of Model::inverse().
struct InverseOptions {
  double pressure_min_kpa = 0;       ///< smallest command [kPa]
  double pressure_max_kpa = 100;     ///< largest command [kPa], above the smallest
  double slew_up_kpa_per_s = 300;    ///< fastest rise of the command [kPa/s], > 0
  double slew_down_kpa_per_s = 300;  ///< fastest fall of the command [kPa/s], > 0
  double start_kpa = 0;              ///< command under which the finger is at rest at the first sample [kPa]
};

/// Result of Model::inverse().
struct Inverse {
  std::vector<double> pressure_kpa;  ///< command [kPa], one per sample, held until the next sample
  /// One value per sample: 1 if, because of the limits, the command does not reach the reference; otherwise
  /// 0.
  std::vector<std::uint8_t> out_of_reach;
};

/// A model: a chain of blocks from the commanded pressure to the sensor reading. It is immutable; copies are
/// cheap and share the parameters. Threads may use one model at the same time.
///
/// The blocks and their sources in the literature are in the reference page "blocks".
class SOFTGRIP_API Model {
 public:
  /// Reads a model file (YAML). Throws FileError.
  [[nodiscard]] static Model load(const std::string& path);
  /// Reads the text of a model file. Throws FileError.
  /// @param yaml  the text
  /// @param name  name of the text in error messages
  [[nodiscard]] static Model parse(const std::string& yaml, const std::string& name = "model");

  /// Writes a model file. load() of this file gives an equal model. Throws FileError.
  void save(const std::string& path) const;
  /// Returns the text of a model file. The numbers have enough digits, so parse() gives an equal model.
  [[nodiscard]] std::string yaml() const;

  /// Returns the name of the model.
  [[nodiscard]] const std::string& name() const noexcept;
  /// Returns the origin of the parameters, in one line.
  [[nodiscard]] const std::string& source() const noexcept;
  /// Returns 16 hexadecimal digits that identify the model: any change of a parameter changes them.
  [[nodiscard]] std::string hash() const;
  /// Returns the unit of the output.
  [[nodiscard]] Unit unit() const noexcept;
  /// Returns all parameters in the order of the chain.
  [[nodiscard]] std::vector<Parameter> parameters() const;
  /// Returns a copy with another value of a parameter. Throws InvalidArgument if there is no such parameter,
  /// or if the copy would not be a valid model.
  /// @param parameter  name of the parameter, as in parameters()
  /// @param value      new value, in the unit of the parameter
  [[nodiscard]] Model with(const std::string& parameter, double value) const;

  /// Simulates the finger, which is at rest under the first pressure. `softgrip simulate` uses the same
  /// function. Throws InvalidArgument.
  /// @param time_s        times [s], at least 1 value, increasing
  /// @param pressure_kpa  commanded pressure [kPa], one per time
  /// @param options       settings of hold, noise, supply pressure and temperature
  /// @return the readings, one per time, in the unit of the model
  [[nodiscard]] std::vector<double> simulate(std::span<const double> time_s,
                                             std::span<const double> pressure_kpa,
                                             const SimulateOptions& options = {}) const;

  /// Computes the command with which the finger follows a displacement. The method is the feedforward
  /// `full_model` of the daemon: it solves hysteresis and creep implicitly, and compensates lags by lead and
  /// dead times by preview. If the first value differs from the displacement at rest, this difference decays
  /// in 0.5 s or more.
  /// simulate() with `held` shows the motion under this command.
  /// Throws InvalidArgument, and Refused if the model has no inverse.
  /// @param time_s        times [s], at least 2 values, with equal steps (within 1e-6 of the step)
  ///                      of 0.0001 to 1 s
  /// @param displacement  the reference in the unit of the model, one value per time
  /// @param options       limits of the command
  [[nodiscard]] Inverse inverse(std::span<const double> time_s, std::span<const double> displacement,
                                const InverseOptions& options = {}) const;

  /// Opaque content.
  struct Parts;
  /// Creates a model from its content; only the library itself uses it.
  explicit Model(std::shared_ptr<const Parts> parts) noexcept;
  /// Returns the content; only the library itself uses it.
  [[nodiscard]] const Parts& parts() const noexcept { return *parts_; }

 private:
  std::shared_ptr<const Parts> parts_;
};

/// Simulates a finger step by step. Construction allocates memory. step() and reset() allocate no memory if
/// `sample_time_s` is given. Only one thread may use an object at a time.
class SOFTGRIP_API Simulator {
 public:
  /// Creates a finger at rest under 0 kPa.
  /// @param model          model of the finger
  /// @param sample_time_s  usual duration of a step [s]; 0: irregular
  /// @param seed           seed of the noise of the model's sensor
  explicit Simulator(const Model& model, double sample_time_s = 0, std::uint64_t seed = 1);
  ~Simulator();
  /// Takes over the state. `other` can then only be assigned to or destroyed.
  Simulator(Simulator&& other) noexcept;
  /// Takes over the state. `other` can then only be assigned to or destroyed.
  Simulator& operator=(Simulator&& other) noexcept;

  /// Resets the model to its state of rest at a constant command [kPa].
  void reset(double pressure_kpa) noexcept;
  /// Simulates a step of `duration_s` [s], >= 0, while the command changes linearly to `pressure_kpa` [kPa].
  /// Returns the reading in the unit of the model. An argument that is not finite, or a negative duration,
  /// gives NaN and changes nothing.
  double step(double duration_s, double pressure_kpa) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip
