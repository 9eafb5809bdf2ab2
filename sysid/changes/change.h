#pragma once
// Diagnoses how a finger has changed since it was healthy. A baseline model is fitted to the healthy logs and
// kept constant. Each cause is fitted as a change of this model.

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "model/model.h"
#include "sysid/changes/change_intervals.h"
#include "sysid/changes/effect_fit.h"
#include "sysid/logs/log.h"

namespace softgrip::sysid {

enum class ChangeVerdict { unchanged, cause_found, ambiguous, partly_explained, unexplained };
[[nodiscard]] const char* name_of(ChangeVerdict verdict);

struct ChangeOptions {
  bool held = false;
  std::optional<model::Model> given;
  std::uint64_t seed = 1;
  unsigned threads = 0;
  std::function<void(const std::string&)> progress;
};

/// Size of a change, stated as a quantity that a technician can check.
struct ChangeSize {
  std::string what;  ///< "dead time", "gain"
  double value = 0;
  std::string unit;  ///< "s", "mm" (of any output unit), "kPa", "%"
};

struct ChangeCause {
  std::string id;
  std::string title;
  model::Station station = model::Station::actuator;
  Judged judged = Judged::displacement;
  model::OutputUnit output_unit = model::OutputUnit::mm;
  FittedEffect fitted;
  ChangeSize size;
  EffectIntervals intervals;
  double full_pressure_mm = 0;  ///< change of the displacement at full pressure
  double effect_mm = 0;         ///< root mean square effect in the later logs
  double share_percent = 0;     ///< share of the whitened error beyond that of the healthy logs that the
                                ///< cause explains
  double gain = 0;              ///< reduction of the whitened mean square, whose healthy value is 1
  double gain_lower = 0, gain_upper = 0;
  std::vector<std::string> alternatives;  ///< ids of causes that explain the data equally well
};

/// A cause that was tested. If it was rejected, `rejected` states the reason.
struct TriedCause {
  std::string id, form;
  double gain = 0;          ///< reduction of the whitened mean square
  double healthy_gain = 0;  ///< mean reduction in healthy units that were left out of the fit
  double tolerance = 0;     ///< smallest reduction that counts as a change
  std::string rejected;     ///< reason of the rejection; empty: not known
};

/// RMS error of the baseline model in a run after subtraction of its mean, without the causes (`base`) and
/// with them (`explained`).
struct RunLeft {
  std::string run;
  bool is_healthy = false;  ///< true: a healthy run that was left out of the fit; it contains no cause
  double base = 0, explained = 0;
};

/// Result for one quantity: the displacement or the pressure.
struct JudgedChange {
  Judged judged = Judged::displacement;
  model::OutputUnit output_unit = model::OutputUnit::mm;
  std::string base;     ///< description of the baseline model
  double noise_mm = 0;  ///< noise between consecutive samples; in kPa for the pressure
  std::size_t healthy_runs = 0;
  double healthy_mm = 0;    ///< RMS error of the baseline model in left-out healthy units
  double allowed_mm = 0;    ///< largest RMS error to be expected in a further healthy run
  double later_mm = 0;      ///< RMS error of the baseline model in the later logs, apart from differences of
                            ///< zero and gain
  double explained_mm = 0;  ///< the same error if the causes are included
  double loss_before = 1, loss_left = 1;  ///< whitened mean squares without and with the causes; 1: as in the
                                          ///< healthy logs
  double zero_mm = 0;                     ///< change of the zero
  double gain_percent = 0;                ///< change of the gain that is within the spread of the healthy
                                          ///< logs
  bool left_over = false;
  std::vector<TriedCause> tried;
  std::vector<EffectIntervals> intervals;  ///< intervals of the causes, in the order in which these were
                                           ///< found
  std::map<std::string, std::string> not_tested;  ///< causes by id, each with the recording that would test
                                                  ///< it
  double bin_s = 0.05;
  std::vector<RunLeft> runs;      ///< all runs, the healthy ones first
  std::vector<std::string> logs;  ///< names of the later logs
  Binned left, explained;         ///< residuals in the later logs: without the causes (left) and with them
                                  ///< (explained)
};

struct ChangeDiagnosis {
  ChangeVerdict verdict = ChangeVerdict::unexplained;
  std::vector<ChangeCause> causes;
  model::OutputUnit output_unit = model::OutputUnit::mm;
  std::vector<JudgedChange> readings;
  std::vector<std::string> warnings;
  double wall_s = 0;
};

/// Compares the later logs with the healthy logs. Returns an error sentence if they cannot be compared.
[[nodiscard]] tl::expected<ChangeDiagnosis, std::string> diagnose_change(const std::vector<Log>& healthy,
                                                                         const std::vector<Log>& later,
                                                                         const ChangeOptions& options = {});

/// Returns the size of a change as text, such as "more dead time 0.03 s".
[[nodiscard]] std::string size_text(const ChangeCause& cause);
/// Returns the interval of the size in its unit, such as "0.0275 .. 0.0325". Returns "-" if there is no
/// interval.
[[nodiscard]] std::string interval_text(const ChangeCause& cause);

/// Returns the verdict as one sentence for a technician.
[[nodiscard]] std::string change_sentence(const ChangeDiagnosis& diagnosis);

}  // namespace softgrip::sysid
