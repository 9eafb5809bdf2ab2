#pragma once
// Diagnoses a change of a finger since it was healthy. A baseline model is fitted to the healthy logs, and
// its parameters then stay constant. Each cause is fitted as a change of the baseline model.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "model/model.h"
#include "sysid/changes/change_intervals.h"
#include "sysid/changes/effect_fit.h"
#include "sysid/changes/orientation.h"
#include "sysid/evidence/comparison.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

enum class ChangeVerdict { unchanged, cause_found, ambiguous, partly_explained, unexplained };
[[nodiscard]] std::string_view name_of(ChangeVerdict verdict);

struct ChangeOptions {
  bool held = false;
  std::optional<model::Model> given;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  std::function<void(const std::string&)> progress;
};

/// Size of a change, stated as a quantity that a technician can check.
struct ChangeSize {
  std::string what;  ///< name of the quantity: "increase of the dead time", "gain"
  double value = 0;
  std::string unit;  ///< unit of the quantity: "s", "mm" (of any output unit), "kPa" or "%"
};

struct ChangeCause {
  std::string id;
  std::string title;
  model::Station station = model::Station::actuator;
  Judged judged = Judged::displacement;
  model::OutputUnit output_unit = model::OutputUnit::mm;
  FittedEffect fitted;
  ChangeSize size;
  EffectIntervals intervals;    ///< `intervals.size` is the interval of `size`
  double full_pressure_mm = 0;  ///< change of the displacement at full pressure due to the cause
  double effect_mm = 0;         ///< root mean square of the effect of the cause on the later readings
  /// Share of the excess error that the cause explains [%]. The excess error is the whitened mean square
  /// minus 1, its value in the healthy logs.
  double share_percent = 0;
  /// Reduction of the whitened mean square by the cause. The whitened mean square is 1 in the healthy logs.
  /// For a cause that is found without a fit (outliers, sampling), it is the mean square error due to the
  /// cause, divided by the variance of the noise.
  double gain = 0;
  std::optional<Interval> gain_interval;    ///< 95 % interval of `gain`; empty for a cause without a fit
  std::optional<ErrorReduction> reduction;  ///< reduction of the whitened RMS error by the cause; empty for a
                                            ///< cause without a fit
  std::vector<std::string> alternatives;  ///< ids of other causes that explain the later readings as well as
                                          ///< this cause

  /// Returns true if this is the id of the cause or of one of its alternatives.
  [[nodiscard]] bool lists(std::string_view any_id) const;
};

/// A cause that was tested as an explanation of the change. If it was rejected, `rejected` states the reason.
struct TriedCause {
  std::string id, form;
  double gain = 0;          ///< reduction of the whitened mean square by the cause
  double healthy_gain = 0;  ///< mean error reduction by the cause in healthy runs, each of which was left out
                            ///< of the fit
  double tolerance = 0;     ///< limit of `gain` above which the cause counts as a change
  /// Reason of the rejection; empty: the cause was not rejected, or no reason was recorded.
  std::string rejected;
};

/// RMS errors of the baseline model in a run. `base` is the error without the causes, and `explained` is the
/// error with the causes. The mean error of the run is subtracted first.
struct RunLeft {
  std::string run;
  bool is_healthy = false;  ///< true: a healthy run that was left out of the fit; the two errors are then
                            ///< equal
  double base = 0, explained = 0;
};

/// Result for one quantity: the displacement or the pressure.
struct JudgedChange {
  Judged judged = Judged::displacement;
  model::OutputUnit output_unit = model::OutputUnit::mm;
  std::string base;  ///< description of the baseline model
  double noise_mm =
      0;  ///< white noise of the readings, estimated from consecutive samples; in kPa for the pressure
  std::size_t healthy_runs = 0;
  double healthy_mm = 0;  ///< RMS error of the baseline model in left-out healthy units
  double allowed_mm = 0;  ///< largest RMS error that is expected in another healthy run
  /// Factor by which an input unlike the healthy inputs increases the permitted mean square error, >= 1.
  double input_factor = 1;
  /// Share of the readings that are not evaluated because they follow an unfamiliar command, 0 .. 1.
  double unevaluated_share = 0;
  /// RMS error of the baseline model in the later logs, after a fit of zero and gain.
  double later_mm = 0;
  double explained_mm = 0;  ///< RMS error in the later logs if the effects of the causes are added to the
                            ///< baseline model
  /// Mean square of the whitened residual in the later logs, without the causes (`loss_before`) and with the
  /// causes (`loss_left`). A healthy log has a mean square of about 1.
  double loss_before = 1, loss_left = 1;
  /// Zero offset of the later readings minus the zero offset of the healthy readings.
  double zero_mm = 0;
  /// Fitted deviation of the gain from the gain in the healthy logs [%]. It is within the spread of the
  /// healthy logs, so it does not count as a change.
  double gain_percent = 0;
  /// True if the causes leave an error that no further healthy run is expected to have, or if the causes
  /// explain less than half of the excess error.
  bool left_over = false;
  /// Sources of uncertainty that the 95 % intervals of the causes contain.
  std::vector<std::string> interval_contains;
  /// Name of the only later log with such an error; empty if there is none, or if other logs also have it.
  std::string unusual_log;
  std::vector<TriedCause> tried;
  /// Causes that were not tested. Key: id of the cause. Value: description of a recording that would test the
  /// cause.
  std::map<std::string, std::string> not_tested;
  double bin_s = 0.05;
  std::vector<RunLeft> runs;      ///< all runs; the healthy runs come first
  std::vector<std::string> logs;  ///< names of the later logs
  /// Residuals in the later logs, averaged over bins: `left` without the causes, `explained` with the causes.
  Binned left, explained;
};

/// Returns the share of the excess error that all causes together explain, 0 .. 1. The excess error is the
/// increase of the squared error since the healthy logs. The share is the larger one of two shares: without
/// and with whitening.
[[nodiscard]] double share_explained(const JudgedChange& judged);

struct ChangeDiagnosis {
  ChangeVerdict verdict = ChangeVerdict::unexplained;
  std::vector<ChangeCause> causes;
  /// Causes that meet all conditions but together explain less than half of the excess error of their
  /// quantity. Another change may have similar effects, so they are not named.
  std::vector<ChangeCause> partial;
  model::OutputUnit output_unit = model::OutputUnit::mm;
  std::vector<JudgedChange> readings;
  /// Name of the first later log whose command no healthy log has; empty: there is none, or the verdict is
  /// ChangeVerdict::unchanged.
  std::string another_command;
  /// Factors by which the logs were multiplied. All results refer to the multiplied logs.
  Orientation orientation;
  std::vector<std::string> warnings;
  double wall_s = 0;
};

/// Compares the later logs with the healthy logs. Returns an error sentence if they cannot be compared.
[[nodiscard]] tl::expected<ChangeDiagnosis, std::string> diagnose_change(const std::vector<Log>& healthy,
                                                                         const std::vector<Log>& later,
                                                                         const ChangeOptions& options = {});

/// Returns the size of a change as text, for example "increase of the dead time 0.03 s".
[[nodiscard]] std::string size_text(const ChangeCause& cause);
/// Returns the interval of the size in the unit of the size, for example "0.0275 .. 0.0325". Returns "-" if
/// there is no interval, and "not determined by these logs" if the interval is too wide (is_determined()).
[[nodiscard]] std::string interval_text(const ChangeCause& cause);

/// Returns the verdict for a technician. If the causes explain less than half of the excess error, a second
/// sentence states them.
[[nodiscard]] std::string change_sentence(const ChangeDiagnosis& diagnosis);

}  // namespace softgrip::sysid
