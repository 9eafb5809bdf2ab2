#pragma once
// Fits the baseline model of a finger to the logs of the healthy finger. The parameters of this model do not
// change afterwards. Its uncertainty is computed from the differences between units. A unit is a run or half
// of a run (sysid/evidence/units.h). The input of the model is the measured pressure or the command.

#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

#include "model/model.h"
#include "sysid/changes/bins.h"
#include "sysid/changes/filter_bank.h"
#include "sysid/changes/regulator.h"
#include "sysid/evidence/units.h"
#include "sysid/fitting/fit_space.h"
#include "sysid/limits/limits.h"
#include "sysid/logs/record.h"

namespace softgrip::sysid {

/// Quantity that is compared with the baseline model. For `pressure`, the model describes the path from the
/// command to pressure_kpa. All members of Base with names that end with _mm are then in kPa.
enum class Judged { displacement, pressure };
[[nodiscard]] constexpr const char* name_of(Judged judged) {
  return judged == Judged::pressure ? "pressure" : "displacement";
}
[[nodiscard]] inline std::string unit_of(Judged judged, model::OutputUnit output_unit) {
  return judged == Judged::pressure ? "kPa" : std::string(model::name_of(output_unit));
}

/// Largest difference between the gains of two runs of an unchanged finger, in standard deviations of the
/// gain. The difference is smaller with the probability limits::probability. Used if there is only one
/// healthy run.
inline constexpr double deviate_between_two_runs = limits::deviate * std::numbers::sqrt2;
/// Largest difference between the gains of two runs of an unchanged finger with the usual spread, as a share
/// of the gain (probability limits::probability).
inline constexpr double usual_gain_difference = deviate_between_two_runs * limits::usual_gain_spread;

/// Parameters of a model of the healthy finger that was fitted to all cross-validation units except one.
struct LeftOutModel {
  model::Model model;
  Eigen::VectorXd filter_weights;
};

/// A model of the healthy finger: a structure with an optional regulator and an optional filter bank.
struct HealthyModel {
  std::string description;
  /// Model of the finger. If the model has no blocks, the baseline model consists of a regulator, a filter
  /// bank or both.
  model::Model model;
  FilterKind kind = FilterKind::finger;
  std::optional<Regulator> regulator;  ///< regulator between the command and the model; empty: none
  Eigen::VectorXd filter_weights;
  double left_mm = 0;  ///< RMS residual of left-out units after subtraction of the mean of each unit
  Binned left;         ///< residual of each unit, predicted by a fit to the other units
  std::vector<LeftOutModel> left_out;  ///< for each unit, the model that was fitted to the other units
};

/// The baseline model: the selected model of the healthy finger and its uncertainty.
struct Base : HealthyModel {
  Judged judged = Judged::displacement;
  Drive drive = Drive::command;
  double largest_kpa = 0;
  double temperature_c = 20;  ///< mean temperature in the healthy logs; 20 if it is not recorded
  double gain_per_c = 0;      ///< temperature coefficient of the gain in the healthy logs
  double noise_mm = 0;        ///< standard deviation of the white noise of the readings (fast_noise_mm())
  Units units;                ///< division of the healthy records into units for cross-validation
  double span_mm = 0;
  double gain_spread = 0;  ///< relative spread of the gain between the healthy runs; with one healthy run, at
                           ///< least limits::usual_gain_spread for the displacement
  double free_gain = 0;  ///< largest relative difference of the gain that does not count as a change, because
                         ///< a further run of an unchanged finger may show it
  double zero_mm = 0;    ///< mean of the healthy readings minus the predictions of the selected model
  double zero_spread_mm = 0;
  double bin_s = 0.05;
  Whitener whitener;
  std::vector<Record> records;  ///< thinned healthy records
  /// Other models whose error on the left-out units could be that of a further healthy run. Where their
  /// predictions differ from those of the selected model, the healthy logs do not determine the response of
  /// the finger.
  std::vector<HealthyModel> alternatives;
};

struct BaseOptions {
  /// Model that the user already uses, as an additional candidate for the baseline model. Not set: the user
  /// has no model.
  std::optional<model::Model> given;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  std::function<void(const std::string&)> progress;
  /// Longest sampling interval of the later records [s]. If the bins would contain fewer than two samples of
  /// such a record, the healthy records are thinned to this interval, so that the means over bins have equal
  /// noise.
  double later_interval_s = 0;
};

/// Fits the baseline model and computes its uncertainty.
/// @param all_samples  records of the healthy finger at the full sampling rate.
[[nodiscard]] Base fit_base(const std::vector<Record>& all_samples, Judged judged, Drive drive,
                            const BaseOptions& options);

/// Returns the bin length for a finger whose pressure is measured [s].
[[nodiscard]] double finger_bin_s(const std::vector<Record>& records);
/// Returns the reading minus the prediction of a model with play operators and creep, as means over bins. The
/// prediction of a cross-validation unit comes from a fit to all other units. The first readings of a record
/// are NaN, because the initial state is estimated from them.
/// @param records  records of the healthy finger with the input that `drive` selects.
[[nodiscard]] Binned left_out_by_play(const std::vector<Record>& records, Drive drive, double bin_s,
                                      unsigned threads);

/// Returns a copy of the record with fewer samples, for the search for changes. Each bin contains several
/// samples. With the shortest bins, the sampling interval is 0.005 s for a pressure and 0.01 s for a
/// displacement.
[[nodiscard]] Record thinned_for(const Base& base, const Record& record);

/// Returns records whose reading is the measured pressure [kPa] and whose drive is the command.
[[nodiscard]] std::vector<Record> pressure_records(const std::vector<Log>& logs, bool held);

/// RMS errors in left-out healthy runs [mm] with the measured pressure and with the command as model input.
/// `drive` is the selected input.
struct DriveChoice {
  Drive drive = Drive::measured;
  double by_pressure_mm = 0, by_command_mm = 0;
};

/// Selects the input of the model. The default is the measured pressure. The command is selected if it
/// predicts left-out healthy displacements significantly better than the measured pressure. In addition, the
/// ratio of the squared errors must exceed run_to_run_factor(). The predictions come from a model with play
/// operators and creep. The measured pressure does not determine the displacement if the pressure is measured
/// in the supply pipe of an actuator that a controlled flow moves, or far from the actuator.
/// @param by_pressure, by_command  records of the same healthy logs with each of the two inputs.
[[nodiscard]] DriveChoice chosen_drive(const std::vector<Record>& by_pressure,
                                       const std::vector<Record>& by_command, std::uint64_t seed,
                                       unsigned threads = 0);

}  // namespace softgrip::sysid
