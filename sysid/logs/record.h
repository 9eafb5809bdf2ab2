#pragma once
// A log as a fit sees it: steps with durations, the pressure that drives the model, readings, surroundings.

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Which column of a log drives the model.
enum class Drive {
  command,   ///< pressure_command_kpa, through the whole chain
  measured,  ///< pressure_kpa, past the blocks of the valve: what the regulator did is known, not modelled
};

/// "command" or "measured pressure", as scores say it.
[[nodiscard]] std::string name_of(Drive drive);

/// The known initial state of a log.
enum class Start {
  automatic,  ///< a fit: rest if the first pressure is nearly 0, otherwise unknown; a prediction: see
              ///< sysid/fitting/start_estimate.h
  rest,       ///< at rest at the first pressure: risen to it once from 0 and settled
  unknown,    ///< hysteresis, creep and offset are estimated
};

/// How to make records of logs.
struct RecordOptions {
  Drive drive = Drive::command;
  Start start = Start::automatic;
  /// The command keeps its value until the next sample, as a board holds it, instead of going straight there.
  bool held = false;
};

/// The state in which a record begins, as far as the model's file does not say it.
struct StartState {
  double offset_mm = 0;  ///< of the sensor's zero
  /// The pressure was here last before it came to the first sample's: sets the hysteresis. At or below the
  /// first pressure it changes nothing.
  double peak_before_kpa = -std::numeric_limits<double>::infinity();
  /// Creep that had not settled, by Kelvin-Voigt branch: decays with the branch's time constant.
  std::vector<double> unsettled_mm;
  /// The pressure was here between the peak and the first sample: sets the hysteresis of a record that begins
  /// while the pressure rises. At or above the first pressure it changes nothing.
  double valley_before_kpa = std::numeric_limits<double>::infinity();
  /// Speed at which the pressure came to the first sample from the last turn before it; 0: it came long ago,
  /// and all has settled.
  double arrival_kpa_per_s = 0;

  bool operator==(const StartState&) const = default;
};

/// One log, prepared. All vectors have the same length, but for temperature and supply, which may be empty.
struct Record {
  std::string name;
  model::OutputUnit output_unit = model::OutputUnit::mm;  ///< of readings and of all members named _mm
  Drive drive = Drive::command;                           ///< which column drive_kpa is
  std::vector<double> time_s;
  std::vector<double> duration_s;  ///< of the step that ends at a sample; the first is 0
  std::vector<double> drive_kpa;
  std::vector<double> reading_mm;  ///< NaN: none
  std::vector<double> temperature_c;
  std::vector<double> supply_kpa;
  double sample_time_s = 0;  ///< 0 when irregular
  /// Interval between distinguishable readings: the log's own mean interval even if only some samples are
  /// left. If a sample is the mean of those around it, it is the interval of the samples that are left.
  double finest_interval_s = 0;
  double campaign_time_s = 0;     ///< when it began, counted from the first log's start
  double span_mm = 0;             ///< of the readings
  double drive_noise_kpa = 0;     ///< of a measured drive, before it was smoothed
  double largest_kpa = 0;         ///< of the drive
  double largest_before_kpa = 0;  ///< of the drive in the campaign's earlier records
  std::size_t readings = 0;       ///< how many are there
  bool held = false;
  Start start = Start::automatic;  ///< what is known about the state in which it begins
  bool start_unknown = false;      ///< a fit estimates that state
  bool offset_free = false;  ///< the start is unknown, or pressure and reading do not begin at 0 together

  [[nodiscard]] std::size_t size() const noexcept { return time_s.size(); }
  /// From the first sample to the last [s]. There is one at least.
  [[nodiscard]] double length_s() const noexcept { return time_s.back() - time_s.front(); }
  /// Mean time between the samples that are here [s]; the nominal one may not be known (sample_time_s).
  [[nodiscard]] double mean_interval_s() const noexcept {
    return length_s() / static_cast<double>(size() > 2 ? size() - 1 : 1);
  }
};

/// The records of a campaign, in order. Measured inputs are smoothed with the noise that they show
/// (input_smoothing.h); values that are missing are taken straight between their neighbours. With
/// Drive::measured every log must have a pressure_kpa column.
[[nodiscard]] std::vector<Record> make_records(const std::vector<Log>& logs, const RecordOptions& options);

/// Takes a reading out of a record, where there is one (NaN: no reading).
void hide_reading(Record& record, std::size_t sample);

/// A step's duration without the rounding of written times: differences below a picosecond go, so that equal
/// durations share their coefficients.
[[nodiscard]] double step_duration_s(double duration_s);

/// The readings' noise, from second differences of neighbours (robust; white noise assumed) [mm].
[[nodiscard]] double fast_noise_mm(const Record& record);

/// The part of a model that is fitted and compared: without noise and quantisation, and, where the measured
/// pressure drives it, without the valve.
[[nodiscard]] model::Model deterministic_part(const model::Model& model, Drive drive);

}  // namespace softgrip::sysid
