#pragma once
// Change of a finger since it was healthy: a base fitted to the healthy logs is held constant, and causes are
// fitted as changes of it.

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

/// A size as a technician checks it.
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
  double full_pressure_mm =
      0;                     ///< what it does to the displacement at the highest pressures of the later logs
  double effect_mm = 0;      ///< root mean square over the later logs
  double share_percent = 0;  ///< of what its reading shows beyond the healthy spread
  double gain = 0;           ///< per bin, in units of the healthy spread
  double gain_lower = 0, gain_upper = 0;
  std::vector<std::string> alternatives;  ///< ids that explain as much
};

/// A cause that was tried, and the reason if it was rejected.
struct TriedCause {
  std::string id, form;
  double gain = 0;
  double healthy_gain = 0;  ///< what it improves in healthy units that are left out, on average
  double tolerance = 0;     ///< what it must improve to be a change
  std::string rejected;     ///< why it is no cause, if that was found out
};

/// Error of the base in a run, root mean square about its mean, without and with the causes.
struct RunLeft {
  std::string run;
  bool is_healthy = false;  ///< then it was left out of the base's fit, and no cause acts
  double base = 0, explained = 0;
};

/// One reading: the displacement, or the pressure.
struct JudgedChange {
  Judged judged = Judged::displacement;
  model::OutputUnit output_unit = model::OutputUnit::mm;
  std::string base;     ///< in words
  double noise_mm = 0;  ///< kPa of the pressure
  std::size_t healthy_runs = 0;
  double healthy_mm = 0;                  ///< what the base leaves of healthy units that are left out
  double allowed_mm = 0;                  ///< what another healthy run may leave
  double later_mm = 0;                    ///< what it leaves of the later ones, but for zero and gain
  double explained_mm = 0;                ///< with the causes
  double loss_before = 1, loss_left = 1;  ///< mean squares, whitened; 1: as on the healthy logs
  double zero_mm = 0;                     ///< by which the zero is another one
  double gain_percent = 0;                ///< within the healthy spread
  bool left_over = false;
  std::vector<TriedCause> tried;
  std::vector<EffectIntervals> intervals;         ///< of its causes, in the order in which they were found
  std::map<std::string, std::string> not_tested;  ///< causes, each with the recording that would show it
  double bin_s = 0.05;
  std::vector<RunLeft> runs;      ///< the healthy ones first
  std::vector<std::string> logs;  ///< names of the later ones
  Binned left, explained;         ///< what the base leaves of them, without and with the causes
};

struct ChangeDiagnosis {
  ChangeVerdict verdict = ChangeVerdict::unexplained;
  std::vector<ChangeCause> causes;
  model::OutputUnit output_unit = model::OutputUnit::mm;
  std::vector<JudgedChange> readings;
  std::vector<std::string> warnings;
  double wall_s = 0;
};

/// Fails with a sentence where the logs cannot be compared.
[[nodiscard]] tl::expected<ChangeDiagnosis, std::string> diagnose_change(const std::vector<Log>& healthy,
                                                                         const std::vector<Log>& later,
                                                                         const ChangeOptions& options = {});

/// "more dead time 0.03 s"
[[nodiscard]] std::string size_text(const ChangeCause& cause);
/// "0.0275 .. 0.0325" of the size, in its unit; "-" where there is none.
[[nodiscard]] std::string interval_text(const ChangeCause& cause);

/// The verdict in one sentence that a technician understands.
[[nodiscard]] std::string change_sentence(const ChangeDiagnosis& diagnosis);

}  // namespace softgrip::sysid
