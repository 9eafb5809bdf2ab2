#pragma once
// Prepares a log for a fit. The result contains the durations of the steps, the input pressure of the model,
// readings, temperature and supply.

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// Column of a log that is the input of the model.
enum class Drive {
  command,   ///< pressure_command_kpa: input of the complete model, including the valve
  measured,  ///< pressure_kpa: input of the model without the blocks of the valve
};

/// Returns "command" or "measured pressure", the name of the drive in the results.
[[nodiscard]] std::string name_of(Drive drive);

/// Assumption about the state of the finger at the beginning of a log: settled, or unknown.
enum class Start {
  /// In a fit, the same as `rest` if the first pressure is nearly 0, otherwise the same as `unknown`. For a
  /// prediction, see sysid/fitting/start_estimate.h.
  automatic,
  /// The finger has settled at the first pressure, which was reached from zero pressure in a single rise.
  rest,
  unknown,  ///< unknown state; a fit estimates hysteresis, creep and offset at the beginning
};

/// Options for the conversion of logs into records.
struct RecordOptions {
  Drive drive = Drive::command;
  Start start = Start::automatic;
  /// True: the command is constant between two samples, because the board holds its output. False: the
  /// command changes linearly between two samples.
  bool held = false;
};

/// Unknown part of the initial state of a record: neither the model nor the samples determine these values.
struct StartState {
  double offset_mm = 0;  ///< offset of the sensor's zero
  /// Last peak of the pressure before the first sample. The hysteresis at the first sample depends on this
  /// peak. A peak at or below the first pressure has no effect.
  double peak_before_kpa = -std::numeric_limits<double>::infinity();
  /// For each Kelvin-Voigt branch, the creep at the first sample minus the settled creep. This difference
  /// decays with the time constant of the branch.
  std::vector<double> unsettled_mm;
  /// Last valley of the pressure between peak_before_kpa and the first sample. If the pressure rises at the
  /// first sample, the hysteresis depends on this valley. A valley at or above the first pressure has no
  /// effect.
  double valley_before_kpa = std::numeric_limits<double>::infinity();
  /// Rate of the pressure between its last reversal and the first sample. 0: the pressure has been constant
  /// for so long that all states have settled.
  double arrival_kpa_per_s = 0;
  /// Shift of the oscillations of the model (model::PeriodicDisturbance), in addition to
  /// Record::oscillation_shift_s.
  double oscillation_shift_s = 0;

  bool operator==(const StartState&) const = default;
};

/// A log that is prepared for a fit. All vectors have the same length, except that temperature and supply may
/// be empty.
struct Record {
  std::string name;
  /// Unit of the readings and of all members whose name ends with _mm.
  model::OutputUnit output_unit = model::OutputUnit::mm;
  Drive drive = Drive::command;  ///< column of the log that drive_kpa contains
  std::vector<double> time_s;
  /// For each sample, the duration of the step that ends at this sample; 0 for the first sample.
  std::vector<double> duration_s;
  std::vector<double> drive_kpa;
  std::vector<double> reading_mm;  ///< reading at each sample; NaN: no reading
  std::vector<double> temperature_c;
  std::vector<double> supply_kpa;
  double sample_time_s = 0;  ///< nominal sampling interval; 0: the sampling is irregular
  /// Shortest interval between two readings that contain independent information [s]. If samples were removed
  /// from the record, this is still the mean interval of the log. If readings were averaged, this is the
  /// interval between the averaged readings.
  double finest_interval_s = 0;
  double campaign_time_s = 0;      ///< start of the record, relative to the start of the first log
  double oscillation_shift_s = 0;  ///< see model::Surroundings and aligned_lines()
  /// Size of the steps of the readings if the sensor is coarse (diagnosis/residual/resolution.h), otherwise
  /// 0.
  double step_mm = 0;
  double span_mm = 0;             ///< range of the readings
  double largest_kpa = 0;         ///< largest magnitude of the drive
  double largest_before_kpa = 0;  ///< largest magnitude of the drive in all records of the campaign before
                                  ///< this one
  std::size_t readings = 0;       ///< number of readings
  bool held = false;
  Start start = Start::automatic;  ///< assumption about the initial state
  bool start_unknown = false;      ///< true: a fit estimates the initial state
  /// True: the initial state is unknown, or the first pressure or the first reading is not 0.
  bool offset_free = false;

  [[nodiscard]] std::size_t size() const noexcept { return time_s.size(); }
  /// Returns the time from the first to the last sample [s]. There must be at least one sample.
  [[nodiscard]] double length_s() const noexcept { return time_s.back() - time_s.front(); }
  /// Returns the mean interval between samples [s]. The mean interval is also defined for irregular sampling.
  [[nodiscard]] double mean_interval_s() const noexcept {
    return length_s() / static_cast<double>(size() > 2 ? size() - 1 : 1);
  }
};

/// Returns the records of a campaign in the order of the logs. Measured inputs are smoothed according to
/// their noise (input_smoothing.h), and missing values are interpolated linearly. For Drive::measured, each
/// log must have a pressure_kpa column.
[[nodiscard]] std::vector<Record> make_records(const std::vector<Log>& logs, const RecordOptions& options);

/// Returns the number of readings in all records.
[[nodiscard]] std::size_t reading_count(const std::vector<Record>& records);

/// Returns the unit of time in which a fit searches for dead times, lags and creep [s]. The unit is 1 s if
/// two conditions are met: 10 sampling intervals (the smallest `finest_interval_s` of the records) are at
/// most 1 s, and half of the longest record is at least 1 s. Otherwise the unit is the geometric mean of this
/// interval and the length of the longest record.
/// @param records  at least one record.
[[nodiscard]] double time_unit_s(const std::vector<Record>& records);
/// Returns the unit of time for a smallest sampling interval and the length of the longest log [s].
[[nodiscard]] double time_unit_s(double interval_s, double length_s);

/// Returns the unit of pressure in which a fit searches for gains and rates per kPa [kPa]. The unit is 1 kPa
/// if the largest pressure is at least 20 kPa, as it is for soft fingers. Otherwise the unit is 5 % of the
/// largest pressure, for example if the pressures of a log are in MPa.
/// @param records  at least one record.
[[nodiscard]] double pressure_unit_kpa(const std::vector<Record>& records);

/// Returns the unit of displacement in which a fit searches for gains [mm]. The unit is 1 mm if the largest
/// span of the readings is from 1 to 40 mm, as it is for soft fingers. For a larger span, the unit is 2.5 %
/// of the span, for example if the readings are in micrometres. For a smaller span, the unit is the span, for
/// example if the readings are in metres. The limits per span are then those of a finger.
/// @param records  at least one record.
[[nodiscard]] double displacement_unit_mm(const std::vector<Record>& records);

/// Sets the reading of a sample to NaN and updates the number of readings in the record.
void hide_reading(Record& record, std::size_t sample);

/// Rounds the duration of a step to 1e-12 s, which removes the rounding errors of the times in files. Steps
/// of equal duration then have identical values and share their precomputed coefficients.
[[nodiscard]] double step_duration_s(double duration_s);

/// Returns the noise of the readings [mm]. The estimate is robust, uses second differences, and assumes white
/// noise.
[[nodiscard]] double fast_noise_mm(const Record& record);

/// Returns the part of a model that is fitted and compared with readings. Sensor noise and quantisation are
/// removed. For Drive::measured, the blocks of the valve are removed too, except a chamber lag.
[[nodiscard]] model::Model deterministic_part(const model::Model& model, Drive drive);

/// Scale of the data of all records.
struct CampaignSize {
  double largest_kpa = 0;  ///< largest magnitude of the input pressure in all records
  double span_mm = 0;      ///< largest span of the readings in a record
  double longest_s = 0;    ///< duration of the longest record
};
[[nodiscard]] CampaignSize campaign_size(const std::vector<Record>& records);

}  // namespace softgrip::sysid
