#pragma once
// A log, prepared for a fit: steps with durations, the input pressure of the model, readings, surroundings.

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// The column of a log that is the input of the model.
enum class Drive {
  command,   ///< pressure_command_kpa, the input of the whole chain
  measured,  ///< pressure_kpa, the input after the blocks of the valve, which are not used
};

/// Returns "command" or "measured pressure", the names in scores.
[[nodiscard]] std::string name_of(Drive drive);

/// The known initial state of a log.
enum class Start {
  automatic,  ///< fit: rest if the first pressure is nearly 0, otherwise unknown; prediction: see
              ///< sysid/fitting/start_estimate.h
  rest,       ///< at rest at the first pressure, which was reached once from 0, and settled
  unknown,    ///< hysteresis, creep and offset are estimated
};

/// Options for the conversion of logs into records.
struct RecordOptions {
  Drive drive = Drive::command;
  Start start = Start::automatic;
  /// True: the command is constant between samples, as on a board. False: it is linear between samples.
  bool held = false;
};

/// The start state of a record that the model does not determine.
struct StartState {
  double offset_mm = 0;  ///< offset of the sensor's zero
  /// The last peak of the pressure before the first sample. It sets the hysteresis. A value at or below the
  /// first pressure has no effect.
  double peak_before_kpa = -std::numeric_limits<double>::infinity();
  /// Unsettled creep of each Kelvin-Voigt branch. It decays with the branch's time constant.
  std::vector<double> unsettled_mm;
  /// The last valley of the pressure between that peak and the first sample. It sets the hysteresis of a
  /// record that begins while the pressure rises. A value at or above the first pressure has no effect.
  double valley_before_kpa = std::numeric_limits<double>::infinity();
  /// Speed of the pressure from its last reversal to the first sample; 0: the pressure arrived long before,
  /// and all states have settled.
  double arrival_kpa_per_s = 0;

  bool operator==(const StartState&) const = default;
};

/// One log, prepared for a fit. All vectors have the same length, except that temperature and supply may be
/// empty.
struct Record {
  std::string name;
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< unit of readings and of all members named _mm
  Drive drive = Drive::command;                           ///< source column of drive_kpa
  std::vector<double> time_s;
  std::vector<double> duration_s;  ///< duration of the step that ends at a sample; the first is 0
  std::vector<double> drive_kpa;
  std::vector<double> reading_mm;  ///< NaN: none
  std::vector<double> temperature_c;
  std::vector<double> supply_kpa;
  double sample_time_s = 0;  ///< 0: irregular
  /// Interval between distinguishable readings: the log's mean interval, even if only some samples remain. If
  /// each remaining sample is a mean, this is the interval of the remaining samples.
  double finest_interval_s = 0;
  double campaign_time_s = 0;     ///< start of the record, relative to the first log's start
  double span_mm = 0;             ///< span of the readings
  double drive_noise_kpa = 0;     ///< noise of a measured drive before smoothing
  double largest_kpa = 0;         ///< largest drive
  double largest_before_kpa = 0;  ///< largest drive in the earlier records of the campaign
  std::size_t readings = 0;       ///< number of readings
  bool held = false;
  Start start = Start::automatic;  ///< known initial state
  bool start_unknown = false;      ///< a fit estimates the initial state
  bool offset_free = false;        ///< the start is unknown, or the first pressure and reading are not both 0

  [[nodiscard]] std::size_t size() const noexcept { return time_s.size(); }
  /// Returns the time from the first to the last sample [s]. There must be at least one sample.
  [[nodiscard]] double length_s() const noexcept { return time_s.back() - time_s.front(); }
  /// Returns the mean interval of the samples [s]. The nominal one, sample_time_s, may be unknown.
  [[nodiscard]] double mean_interval_s() const noexcept {
    return length_s() / static_cast<double>(size() > 2 ? size() - 1 : 1);
  }
};

/// Returns the records of a campaign in their order. Measured inputs are smoothed according to their noise
/// (input_smoothing.h), and missing values are interpolated linearly. With Drive::measured, each log must
/// have a pressure_kpa column.
[[nodiscard]] std::vector<Record> make_records(const std::vector<Log>& logs, const RecordOptions& options);

/// Removes the reading of a sample, if it has one (NaN: no reading).
void hide_reading(Record& record, std::size_t sample);

/// Rounds the duration of a step to 1e-12 s, which removes the rounding errors of written times, so that
/// equal durations share their coefficients.
[[nodiscard]] double step_duration_s(double duration_s);

/// Returns the noise of the readings [mm], a robust estimate from second differences that assumes white
/// noise.
[[nodiscard]] double fast_noise_mm(const Record& record);

/// Returns the part of a model that is fitted and compared: without noise and quantisation, and with
/// Drive::measured without the valve.
[[nodiscard]] model::Model deterministic_part(const model::Model& model, Drive drive);

}  // namespace softgrip::sysid
