#include "tools/baseline/commissioning_run.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

#include "base/files.h"
#include "base/numbers.h"
#include "base/statistics.h"
#include "base/time.h"
#include "daemon/service/signals.h"
#include "sysid/diagnosis/experiments/experiment.h"
#include "sysid/identification/validate.h"
#include "sysid/logs/simulated_log.h"

namespace softgrip::tools {
namespace {

using Failure = tl::unexpected<NotCommissioned>;

/// Highest pressure of the first, gentle motion, as a share of the largest pressure of the channel. If the
/// model predicts too small a motion, the share is raised in steps, up to 1.
constexpr double gentle_share = 0.3;
constexpr double share_step = 0.1;
/// Smallest measured displacement that counts as a motion, as a multiple of the noise of a reading. The
/// difference between the largest and the first of several thousand readings at rest is smaller.
constexpr double noises = 10;
/// Smallest displacement that the model must predict for the gentle motion, as a multiple of the smallest
/// displacement that counts as a motion, and as a share of displacement_max_mm.
constexpr double motions = 2;
constexpr double least_share_of_range = 0.01;
/// Smallest measured displacement that counts as a motion, as a share of the displacement that the model
/// predicts.
constexpr double least_motion = 0.1;
/// Largest displacement in the experiments, as a share of the distance from rest to displacement_max_mm.
constexpr double range_share = 0.9;
constexpr int most_corrections = 8;
/// Additional time for each motion [s]. Its planned duration does not contain this time for measuring at
/// rest, connecting to the board and disconnecting.
constexpr double pause_s = 3;

/// Returns a waveform of slow triangles from 0 to `share` times the largest pressure.
sysid::Waveform slow(const char* name, const char* about, double share, int count,
                     const sysid::RigLimits& limits) {
  const double top_kpa = share * limits.pressure_max_kpa;
  const double rise_s = std::max(3.0, std::ceil(2 * top_kpa / limits.slew_kpa_per_s));
  sysid::Waveform waveform{name, about, {{0, 0}, {1, 0}}};
  for (int i = 0; i < 2 * count; ++i)
    waveform.corners.push_back({waveform.duration_s() + rise_s, i % 2 == 0 ? top_kpa : 0});
  waveform.corners.push_back({waveform.duration_s() + 3, 0});
  return waveform;
}

sysid::Waveform gentle(const sysid::RigLimits& limits, double share) {
  return slow("gentle_motion", "gentle motion that measures the range of the finger", share, 1, limits);
}

/// Returns the motion that precedes the first run. It is needed because the first motion to a displacement,
/// and the first motion after a long pause, are different from later motions. The first motion also changes
/// the rest position.
sysid::Waveform first_load(const sysid::RigLimits& limits) {
  return slow("first_load", "motion to the full pressure, so that both runs begin after equal loads", 1, 2,
              limits);
}

std::vector<sysid::Waveform> chosen(const std::vector<std::string>& names, const sysid::RigLimits& limits) {
  std::vector<sysid::Waveform> result;
  const std::vector<sysid::Waveform> menu = sysid::experiment_menu(limits);
  for (const std::string& name : names) {
    const auto found = std::find_if(menu.begin(), menu.end(),
                                    [&](const sysid::Waveform& waveform) { return waveform.name == name; });
    if (found != menu.end()) result.push_back(*found);
  }
  return result;
}

/// The reading of a finger at rest in a log, and the largest displacement in this log.
struct Reach {
  double rest_mm = std::nan("");
  double motion_mm = 0;
};

Reach reach_of(const sysid::Log& log) {
  Reach reach;
  for (const double reading_mm : log.displacement_mm) {
    if (!std::isfinite(reading_mm)) continue;
    if (std::isnan(reach.rest_mm)) reach.rest_mm = reading_mm;
    reach.motion_mm = std::max(reach.motion_mm, reading_mm - reach.rest_mm);
  }
  return reach;
}

/// Returns the displacement that the model of the rig file predicts for a waveform [mm].
double expected_mm(const ExperimentRig& rig, const sysid::Waveform& waveform) {
  const control::RigSettings& settings = rig.rig.settings;
  sysid::Log log;
  log.pressure_command_kpa = sysid::sampled_kpa(waveform, 1 / settings.rate_hz);
  for (std::size_t i = 0; i < log.pressure_command_kpa.size(); ++i)
    log.time_s.push_back(static_cast<double>(i) / settings.rate_hz);
  simulate(settings.channels[rig.channel].model, {}, log);
  return reach_of(log).motion_mm;
}

/// Returns the standard deviation of the valid readings before the pressure rises [mm].
double noise_at_rest_mm(const sysid::Log& log) {
  Moments readings;
  for (std::size_t i = 0; i < log.size() && log.pressure_command_kpa[i] <= 0; ++i) {
    if (std::isfinite(log.displacement_mm[i])) readings.add(log.displacement_mm[i]);
  }
  return readings.deviation();
}

/// Returns limits of the rig for the experiments. Up to the largest pressure of these limits, the finger uses
/// at most `range_share` of its displacement range.
/// @param ratio    measured displacement divided by the displacement that the model predicts.
/// @param rest_mm  reading of the sensor at rest.
sysid::RigLimits limits_for(const ExperimentRig& rig, const std::vector<std::string>& experiments,
                            double ratio, double rest_mm) {
  sysid::RigLimits limits = rig.limits(0, 0);
  const double room_mm =
      range_share * (rig.rig.settings.channels[rig.channel].limits.displacement_max_mm - rest_mm);
  for (int i = 0; i < most_corrections; ++i) {
    double furthest_mm = 0;
    for (const sysid::Waveform& waveform : chosen(experiments, limits))
      furthest_mm = std::max(furthest_mm, ratio * expected_mm(rig, waveform));
    if (furthest_mm <= room_mm) break;
    limits.pressure_max_kpa *= std::clamp(0.98 * room_mm / furthest_mm, 0.1, 0.98);
  }
  return limits;
}

class Commissioning {
 public:
  Commissioning(const ExperimentRig& rig, const CommissioningOptions& options)
      : rig_(rig), options_(options) {}

  tl::expected<CommissioningRuns, NotCommissioned> run() {
    runs_.limits = limits_for(rig_, options_.experiments, 1, 0);
    if (const auto chosen = choose_gentle(); !chosen) return Failure(chosen.error());
    if (!rig_.simulated && options_.consent && !options_.consent(what_moves()))
      return fails(ExitCode::failed, "softgrip was not allowed to move the rig");
    signals_.emplace();
    const ScratchFolder scratch;
    if (scratch.path().empty())
      return fails(ExitCode::io, "the folder for the recordings could not be created");
    if (const auto begun = begin(scratch.path()); !begun) return Failure(begun.error());
    for (auto* const logs : {&runs_.first, &runs_.second}) {
      const std::string run = logs == &runs_.first ? "run_1" : "run_2";
      if (const auto whole = play_all(scratch.path() + "/" + run, run, *logs); !whole)
        return Failure(whole.error());
    }
    return std::move(runs_);
  }

 private:
  static Failure fails(ExitCode code, std::string why) {
    return Failure(NotCommissioned{code, std::move(why)});
  }

  [[nodiscard]] std::string what_moves() const {
    double length_s = gentle_.duration_s() + first_load(runs_.limits).duration_s() + 2 * pause_s;
    const auto waveforms = chosen(options_.experiments, runs_.limits);
    for (const sysid::Waveform& waveform : waveforms)
      length_s += 2 * (options_.rest_s + waveform.duration_s() + pause_s);
    return "channel '" + rig_.channel_name() + "' of " + rig_.rig.name +
           " will move: first one gentle motion, then each of " + std::to_string(waveforms.size()) +
           " experiments twice, with at most " + significant(runs_.limits.pressure_max_kpa, 3) +
           " kPa, in about " + significant(length_s / 60, 2) +
           " minutes. Remove all objects from the range of the finger";
  }

  static std::string no_motion(double found, double expected) {
    return "the finger hardly moved: " + significant(found, 2) + " mm, but the model predicts " +
           significant(expected, 2) +
           " mm. Check the air supply, and check that the sensor measures this finger (softgrip doctor "
           "--move)";
  }

  /// Chooses the pressure of the gentle motion such that the model predicts a clear motion. Fails if the
  /// model predicts no clear motion for the largest pressure.
  tl::expected<void, NotCommissioned> choose_gentle() {
    const control::ChannelSettings& channel = rig_.rig.settings.channels[rig_.channel];
    const double least_mm = std::max(motions * noises * channel.health.noise_mm,
                                     least_share_of_range * channel.limits.displacement_max_mm);
    for (double share = gentle_share;; share = std::min(1.0, share + share_step)) {
      gentle_ = gentle(runs_.limits, share);
      gentle_mm_ = expected_mm(rig_, gentle_);
      if (gentle_mm_ >= least_mm) return {};
      if (share >= 1) break;
    }
    return fails(ExitCode::not_acceptable,
                 "the model of the rig file predicts a motion of " + significant(gentle_mm_, 2) + " mm at " +
                     significant(runs_.limits.pressure_max_kpa, 3) + " kPa, but at least " +
                     significant(least_mm, 2) +
                     " mm are necessary. Check the model, pressure_max_kpa and the noise of the sensor");
  }

  /// Plays the gentle motion, and computes the limits of the experiments from the displacement during this
  /// motion.
  tl::expected<void, NotCommissioned> begin(const std::string& folder) {
    const auto log = play(gentle_, folder);
    if (!log) return Failure(log.error());
    const Reach reach = reach_of(*log);
    const double least_mm = std::max(least_motion * gentle_mm_, noises * noise_at_rest_mm(*log));
    if (!(reach.motion_mm > least_mm))
      return fails(ExitCode::not_acceptable, no_motion(reach.motion_mm, gentle_mm_));
    if (auto free = check_free(*log); !free) return free;
    runs_.limits = limits_for(rig_, options_.experiments, std::max(1.0, reach.motion_mm / gentle_mm_),
                              std::max(0.0, reach.rest_mm));
    const auto loaded = play(first_load(runs_.limits), folder);
    if (!loaded) return Failure(loaded.error());
    return check_free(*loaded);
  }

  /// Plays the experiments of one run, each after a rest, and appends their logs.
  tl::expected<void, NotCommissioned> play_all(const std::string& folder, const std::string& run,
                                               std::vector<sysid::Log>& logs) {
    for (const sysid::Waveform& waveform : chosen(options_.experiments, runs_.limits)) {
      const double rest_s =
          rig_.simulated ? 0 : options_.rest_s;  // a simulated rig needs no rest, because it starts each
                                                 // motion from its initial state
      if (signals_->wait(nanoseconds(rest_s)) != 0)
        return fails(ExitCode::failed, "stopped by the user; the rig is vented");
      runs_.minutes += rest_s / 60;
      const std::string number = std::to_string(logs.size() + 1);
      auto log = play(waveform, folder + "/" + number,
                      run + ", " + number + " of " + std::to_string(options_.experiments.size()));
      if (!log) return Failure(log.error());
      if (auto free = check_free(*log); !free) return free;
      log->name = waveform.name;
      logs.push_back(std::move(*log));
    }
    return {};
  }

  tl::expected<sysid::Log, NotCommissioned> play(const sysid::Waveform& waveform, const std::string& folder,
                                                 const std::string& title = "first") {
    if (options_.tell)
      options_.tell(title + ": " + waveform.name + ", up to " + significant(highest_kpa(waveform), 3) +
                    " kPa, " + significant(waveform.duration_s(), 3) + " s");
    auto log = played_on(rig_.at(++motions_), waveform.name,
                         sysid::sequence_yaml(waveform, rig_.channel_name()), folder);
    if (!log) return fails(log.error().code, log.error().why);
    runs_.minutes += waveform.duration_s() / 60;
    if (const auto why = broken_promise(waveform, *log)) return fails(ExitCode::not_acceptable, *why);
    return std::move(*log);
  }

  tl::expected<void, NotCommissioned> check_free(const sysid::Log& log) const {
    const model::Model& model = rig_.rig.settings.channels[rig_.channel].model;
    const auto why = touched(sysid::validate_logs(model, {log}), log, runs_.limits.pressure_max_kpa);
    if (why) return fails(ExitCode::not_acceptable, *why);
    return {};
  }

  static double highest_kpa(const sysid::Waveform& waveform) {
    double highest = 0;
    for (const sysid::Corner& corner : waveform.corners) highest = std::max(highest, corner.pressure_kpa);
    return highest;
  }

  const ExperimentRig& rig_;
  const CommissioningOptions& options_;
  // Receives the signals. This object is created after the user has given consent. It holds a signal back
  // until the recordings are removed, so that the signal does not end the process between two motions.
  std::optional<daemon::Signals> signals_;
  CommissioningRuns runs_;
  sysid::Waveform gentle_;  // the first, gentle motion
  double gentle_mm_ = 0;    // displacement that the model predicts for the gentle motion [mm]
  std::uint64_t motions_ = 0;
};

}  // namespace

const std::vector<std::string>& usual_commissioning() {
  static const std::vector<std::string> names{"staircase_with_holds", "triangles_three_rates", "minor_loops",
                                              "sharp_steps"};
  return names;
}

tl::expected<CommissioningRuns, NotCommissioned> play_commissioning(const ExperimentRig& rig,
                                                                    const CommissioningOptions& options) {
  return Commissioning(rig, options).run();
}

}  // namespace softgrip::tools
