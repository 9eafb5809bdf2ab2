#pragma once
// A log that is prepared for a fit: steps with durations, the input pressure of the model, readings,
// temperature and supply.

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "model/model.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

/// The column of a log that is the input of the model.
enum class Drive {
  command,   ///< pressure_command_kpa: input of the complete model
  measured,  ///< pressure_kpa: input behind the valve, whose blocks are not used
};

/// Returns "command" or "measured pressure", the name of the drive in the results.
[[nodiscard]] std::string name_of(Drive drive);

/// Information about the state of the finger at the beginning of a log.
enum class Start {
  /// In a fit, rest if the first pressure is nearly 0, otherwise unknown; in a prediction, see
  /// sysid/fitting/start_estimate.h.
  automatic,
  rest,     ///< settled at the first pressure, which was reached by a single rise from 0
  unknown,  ///< hysteresis, creep and offset at the beginning are estimated
};

/// Options for the conversion of logs into records.
struct RecordOptions {
  Drive drive = Drive::command;
  Start start = Start::automatic;
  /// True: the command is constant between samples, as a board holds its output. False: it is linear between
  /// samples.
  bool held = false;
};

/// The part of a record's initial state that does not follow from the model.
struct StartState {
  double offset_mm = 0;  ///< offset of the sensor's zero
  /// Last peak of the pressure before the first sample, which determines the hysteresis. A peak that is not
  /// above the first pressure has no effect.
  double peak_before_kpa = -std::numeric_limits<double>::infinity();
  /// Part of the creep of each Kelvin-Voigt branch that has not settled yet. It decays with the time constant
  /// of the branch.
  std::vector<double> unsettled_mm;
  /// Last valley of the pressure between this peak and the first sample. It determines the hysteresis of a
  /// record that begins while the pressure rises. A valley that is not below the first pressure has no
  /// effect.
  double valley_before_kpa = std::numeric_limits<double>::infinity();
  /// Speed of the pressure from its last reversal to the first sample. 0: the pressure has been constant for
  /// so long that all states have settled.
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
  std::vector<double> reading_mm;  ///< NaN: no reading
  std::vector<double> temperature_c;
  std::vector<double> supply_kpa;
  double sample_time_s = 0;  ///< nominal sampling interval; 0: the sampling is irregular
  /// Interval between readings that can be distinguished. This is the mean interval of the log, even if
  /// samples were removed. If the remaining readings are means, it is the interval of the remaining samples.
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
  /// Returns the mean interval of the samples [s], which exists even if the sampling is irregular.
  [[nodiscard]] double mean_interval_s() const noexcept {
    return length_s() / static_cast<double>(size() > 2 ? size() - 1 : 1);
  }
};

/// Returns the records of a campaign in the order of the logs. Measured inputs are smoothed according to
/// their noise (input_smoothing.h), and missing values are interpolated linearly. For Drive::measured, each
/// log must have a pressure_kpa column.
[[nodiscard]] std::vector<Record> make_records(const std::vector<Log>& logs, const RecordOptions& options);

/// Removes the reading of a sample if the sample has one, by setting it to NaN.
void hide_reading(Record& record, std::size_t sample);

/// Rounds the duration of a step to 1e-12 s. This removes rounding errors of times in files, so that steps of
/// equal duration share their coefficients.
[[nodiscard]] double step_duration_s(double duration_s);

/// Returns the noise of the readings [mm]. It is a robust estimate from second differences and assumes white
/// noise.
[[nodiscard]] double fast_noise_mm(const Record& record);

/// Returns the part of a model that is fitted and compared with readings: the model without sensor noise and
/// quantisation. For Drive::measured, the blocks of the valve are removed too, except a chamber lag.
[[nodiscard]] model::Model deterministic_part(const model::Model& model, Drive drive);

}  // namespace softgrip::sysid
