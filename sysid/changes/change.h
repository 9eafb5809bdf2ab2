#pragma once
// Diagnoses the change of a finger since it was healthy. A base is fitted to the healthy logs and kept
// constant. Causes are fitted as changes of it.

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

/// A size that a technician can check.
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
  double effect_mm = 0;         ///< root mean square in the later logs
  double share_percent = 0;     ///< share of the error beyond the healthy spread
  double gain = 0;              ///< improvement per bin, in units of the healthy spread
  double gain_lower = 0, gain_upper = 0;
  std::vector<std::string> alternatives;  ///< ids of causes that explain the data equally well
};

/// A cause that was tested, and the reason if it was rejected.
struct TriedCause {
  std::string id, form;
  double gain = 0;
  double healthy_gain = 0;  ///< mean improvement in healthy units that are left out
  double tolerance = 0;     ///< smallest improvement of a change
  std::string rejected;     ///< reason of the rejection, if known
};

/// RMS error of the base in a run about its mean, without and with the causes.
struct RunLeft {
  std::string run;
  bool is_healthy = false;  ///< the run was left out of the fit, and no cause acts
  double base = 0, explained = 0;
};

/// Result for one reading: the displacement or the pressure.
struct JudgedChange {
  Judged judged = Judged::displacement;
  model::OutputUnit output_unit = model::OutputUnit::mm;
  std::string base;     ///< description
  double noise_mm = 0;  ///< sample-to-sample noise; in kPa for the pressure
  std::size_t healthy_runs = 0;
  double healthy_mm = 0;    ///< error of the base in left-out healthy units
  double allowed_mm = 0;    ///< largest expected error in another healthy run
  double later_mm = 0;      ///< error of the base in the later logs, without differences of zero and gain
  double explained_mm = 0;  ///< error with the causes
  double loss_before = 1, loss_left = 1;  ///< whitened mean squares; 1: as in the healthy logs
  double zero_mm = 0;                     ///< change of the zero
  double gain_percent = 0;                ///< change of the gain within the healthy spread
  bool left_over = false;
  std::vector<TriedCause> tried;
  std::vector<EffectIntervals> intervals;  ///< intervals of its causes, in the order in which they were found
  std::map<std::string, std::string> not_tested;  ///< causes, each with the recording that would test it
  double bin_s = 0.05;
  std::vector<RunLeft> runs;      ///< healthy runs first
  std::vector<std::string> logs;  ///< names of the later logs
  Binned left, explained;         ///< residuals in the later logs, without and with the causes
};

struct ChangeDiagnosis {
  ChangeVerdict verdict = ChangeVerdict::unexplained;
  std::vector<ChangeCause> causes;
  model::OutputUnit output_unit = model::OutputUnit::mm;
  std::vector<JudgedChange> readings;
  std::vector<std::string> warnings;
  double wall_s = 0;
};

/// Returns an error sentence if the logs cannot be compared.
[[nodiscard]] tl::expected<ChangeDiagnosis, std::string> diagnose_change(const std::vector<Log>& healthy,
                                                                         const std::vector<Log>& later,
                                                                         const ChangeOptions& options = {});

/// Returns the size as a text: "more dead time 0.03 s".
[[nodiscard]] std::string size_text(const ChangeCause& cause);
/// Returns the interval of the size in its unit: "0.0275 .. 0.0325", or "-" if there is none.
[[nodiscard]] std::string interval_text(const ChangeCause& cause);

/// Returns the verdict as one sentence for a technician.
[[nodiscard]] std::string change_sentence(const ChangeDiagnosis& diagnosis);

}  // namespace softgrip::sysid
