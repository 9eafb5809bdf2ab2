#pragma once
/// @file
/// Declares the models of a finger, their simulation and their inverse. The changelog announces every
/// incompatible change of this interface.

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
  mm,   ///< the output is a displacement in mm
  deg,  ///< the output is a bending angle in degrees
};

/// Returns the name of a unit: "mm" or "deg".
[[nodiscard]] SOFTGRIP_API std::string name_of(Unit unit);

/// One parameter of a model.
struct Parameter {
  std::string name;   ///< name of the parameter, for example "kelvin_voigt.k1_kpa_per_mm"
  double value = 0;   ///< value of the parameter, in `unit`
  std::string unit;   ///< unit of the parameter, for example "kPa/mm"; empty: the parameter has no unit
  double lower = 0;   ///< smallest permitted value of the parameter
  double upper = 0;   ///< largest permitted value of the parameter
  std::string about;  ///< description of the parameter in one line
};

/// Settings of Model::simulate().
struct SimulateOptions {
  /// False: the pressure is linear between samples. True: the pressure of each sample is constant until the
  /// next sample, because a board holds its output. With `held` = true, the displacement of a sample does not
  /// depend on the pressure of this sample.
  bool held = false;
  double noise = 0;  ///< standard deviation of white noise on the output, in the unit of the model; >= 0
  std::uint64_t seed = 1;                      ///< seed of the random numbers of all noise; equal seeds give
                                               ///< identical results
  std::span<const double> supply_kpa = {};     ///< supply pressure [kPa], one value per sample; may be empty
  std::span<const double> temperature_c = {};  ///< temperature of the finger [degrees Celsius], one value per
                                               ///< sample; may be empty
};

/// Settings of Model::inverse().
struct InverseOptions {
  double pressure_min_kpa = 0;       ///< smallest permitted command [kPa]
  double pressure_max_kpa = 100;     ///< largest permitted command [kPa]; it must be above pressure_min_kpa
  double slew_up_kpa_per_s = 300;    ///< largest rate of increase of the command [kPa/s], > 0
  double slew_down_kpa_per_s = 300;  ///< largest rate of decrease of the command [kPa/s], > 0
  double start_kpa = 0;              ///< command under which the finger rests at the first sample [kPa]
};

/// Result of Model::inverse().
struct Inverse {
  std::vector<double> pressure_kpa;  ///< command [kPa], one value per sample; the board holds each value
                                     ///< until the next sample
  /// One value per sample: 1 if the finger cannot reach the reference because of the limits of the command,
  /// otherwise 0.
  std::vector<std::uint8_t> out_of_reach;
};

/// A model: a chain of blocks from the commanded pressure to the sensor reading. A Model object is immutable.
/// Copies need little memory, because they share the parameters. Several threads may use one model at the
/// same time.
///
/// The reference page "blocks" describes the blocks and their sources in the literature.
class SOFTGRIP_API Model {
 public:
  /// Reads a model file (YAML). Throws FileError if the file cannot be read or is not a valid model.
  [[nodiscard]] static Model load(const std::string& path);
  /// Reads the text of a model file. Throws FileError if the text is not a valid model.
  /// @param yaml  text of the model file
  /// @param name  name that error messages use for the text
  [[nodiscard]] static Model parse(const std::string& yaml, const std::string& name = "model");

  /// Writes a model file, from which load() reads an equal model. Throws FileError if the file cannot be
  /// written.
  void save(const std::string& path) const;
  /// Returns the text of a model file. The numbers have all digits that parse() needs to create an equal
  /// model.
  [[nodiscard]] std::string yaml() const;

  /// Returns the name of the model.
  [[nodiscard]] const std::string& name() const noexcept;
  /// Returns the origin of the parameters, in one line.
  [[nodiscard]] const std::string& source() const noexcept;
  /// Returns 16 hexadecimal digits that identify the model. Any change of a parameter changes these digits.
  [[nodiscard]] std::string hash() const;
  /// Returns the unit of the output.
  [[nodiscard]] Unit unit() const noexcept;
  /// Returns all parameters in the order of the chain.
  [[nodiscard]] std::vector<Parameter> parameters() const;
  /// Returns a copy of the model in which one parameter has the value `value`. Throws InvalidArgument if the
  /// model has no parameter of this name, or if the copy would not be a valid model.
  /// @param parameter  name of the parameter, as in parameters()
  /// @param value      new value, in the unit of the parameter
  [[nodiscard]] Model with(const std::string& parameter, double value) const;

  /// Simulates the finger. At the start, the finger is at rest under the first pressure. The command
  /// `softgrip simulate` computes its result in the same way. Throws InvalidArgument if an argument is
  /// invalid.
  /// @param time_s  times [s], at least 1 value, increasing
  /// @param pressure_kpa  commanded pressure [kPa], one value per time
  /// @param options  settings of hold, noise, supply pressure and temperature
  /// @return the readings, one value per time, in the unit of the model
  [[nodiscard]] std::vector<double> simulate(std::span<const double> time_s,
                                             std::span<const double> pressure_kpa,
                                             const SimulateOptions& options = {}) const;

  /// Computes the command for which the displacement of the finger follows a reference. The method is the
  /// feedforward `full_model` of the daemon. This feedforward inverts hysteresis and creep implicitly,
  /// compensates lags by lead, and compensates dead times by preview. If the first value of the reference
  /// differs from the displacement at rest, this difference decays in 0.5 s or more. Call simulate() with
  /// this command and `held` = true to compute the displacement that the finger then has. Throws
  /// InvalidArgument if an argument is invalid, and Refused if the model has no inverse.
  /// @param time_s  times [s], at least 2 values, with equal steps (within 1e-6 of the step) of 0.0001 to 1 s
  /// @param displacement  the reference in the unit of the model, one value per time
  /// @param options  limits of the command
  [[nodiscard]] Inverse inverse(std::span<const double> time_s, std::span<const double> displacement,
                                const InverseOptions& options = {}) const;

  /// Internal data of the object; the definition is not public.
  struct Parts;
  /// Creates a model from its internal data. Only the library calls this constructor.
  explicit Model(std::shared_ptr<const Parts> parts) noexcept;
  /// Returns the internal data of the model. Only the library calls this function.
  [[nodiscard]] const Parts& parts() const noexcept { return *parts_; }

 private:
  std::shared_ptr<const Parts> parts_;
};

/// Simulates a finger step by step. The constructor allocates memory. If `sample_time_s` is above 0 and at
/// least a millionth of the dead time of the model, step() and reset() allocate no memory. Only one thread at
/// a time may use an object.
class SOFTGRIP_API Simulator {
 public:
  /// Creates a finger at rest under 0 kPa. Throws InvalidArgument if `sample_time_s` is invalid.
  /// @param model          model of the finger
  /// @param sample_time_s  usual duration of a step [s], at least 1e-6; 0: the durations are irregular
  /// @param seed           seed of the noise of the model's sensor
  explicit Simulator(const Model& model, double sample_time_s = 0, std::uint64_t seed = 1);
  ~Simulator();
  /// Moves the state of `other` into this object. After this call, `other` may only be destroyed or get a new
  /// value by assignment.
  Simulator(Simulator&& other) noexcept;
  /// Moves the state of `other` into this object. After this call, `other` may only be destroyed or get a new
  /// value by assignment.
  Simulator& operator=(Simulator&& other) noexcept;

  /// Sets the state of a finger at rest under the constant command `pressure_kpa` [kPa].
  void reset(double pressure_kpa) noexcept;
  /// Simulates a step of `duration_s` [s], >= 0, in which the command changes linearly to `pressure_kpa`
  /// [kPa]. Returns the reading in the unit of the model. If an argument is not finite, or if the duration is
  /// negative, the function returns NaN and does not change the state.
  double step(double duration_s, double pressure_kpa) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip
