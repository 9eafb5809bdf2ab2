#include "tools/commissioning/motion.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/periodic_schedule.h"
#include "control/feedforward/running_model.h"
#include "daemon/recording/csv_row.h"
#include "rig/rig_file.h"

namespace softgrip::tools::doctor {
namespace {

/// Smallest displacement that counts as a motion, as a multiple of the noise of a reading.
constexpr double noises = 6;
/// Smallest displacement that counts as a motion, as a share of the displacement that the model predicts.
constexpr double share_of_model = 0.2;
/// Largest tolerated difference between the pressure monitor and the command, as a share of the commanded
/// step. Linearity errors of ordinary valves and boards are of this size.
constexpr double allowed_share_of_step = 0.1;
/// Smallest tolerance of the pressure [kPa]. It is needed because valves cannot control the lowest pressures
/// accurately.
constexpr double pressure_floor_kpa = 1;

/// Simulates the model of a finger while this finger moves. The simulation starts at rest and gets the same
/// commands as the finger.
class Beside {
 public:
  Beside(const control::ChannelSettings& channel, double tick_s, double rest_mm)
      : model_(channel.model, tick_s, 0, tick_s),
        tick_s_(tick_s),
        rest_mm_(rest_mm),
        held_kpa_(control::resting_kpa(channel.limits)) {
    model_.reset(held_kpa_);
    origin_mm_ = model_.reading_mm(0);
  }

  /// Processes the result of one exchange with the board. The command was written after the reading was
  /// taken.
  void take(const model::Reading& reading, double command_kpa) {
    pass_time(reading.sampled_at);
    const double moved_mm = model_.reading_mm(0) - origin_mm_;
    sum_mm_ += moved_mm;
    ++taken_;
    if (reading.validity == model::Validity::valid) {
      const double residual = reading.displacement_mm - rest_mm_ - moved_mm;
      squares_ += residual * residual;
      ++count_;
    }
    held_kpa_ = command_kpa;
  }
  /// Starts a new average of the model's displacement, which mean_mm() returns.
  void begin_mean() {
    sum_mm_ = 0;
    taken_ = 0;
  }
  /// Returns the mean displacement of the model relative to its rest position [mm].
  [[nodiscard]] double mean_mm() const { return taken_ > 0 ? sum_mm_ / static_cast<double>(taken_) : 0; }
  [[nodiscard]] double rms_mm() const {
    return count_ > 0 ? std::sqrt(squares_ / static_cast<double>(count_)) : 0;
  }

 private:
  /// Advances the model by the measured time. On a busy computer, a cycle can take longer than planned.
  void pass_time(Nanoseconds now) {
    if (first_ == 0) first_ = now;
    const auto due = std::llround(seconds(now - first_) / tick_s_);
    for (; ticks_ < due; ++ticks_) model_.advance(held_kpa_);
  }

  control::RunningModel model_;
  double tick_s_;
  double rest_mm_;
  double held_kpa_;
  Nanoseconds first_ = 0;
  long long ticks_ = 0;
  double origin_mm_ = 0;
  double sum_mm_ = 0;
  std::size_t taken_ = 0;
  double squares_ = 0;
  std::size_t count_ = 0;
};

void judge_model(const control::ChannelSettings& channel, const Motion& motion, Findings& findings) {
  const control::ModelHealthSettings& health = channel.health;
  const double healthy_mm = 2 * std::hypot(health.model_error_mm, health.noise_mm);
  const std::string text = fmt::format(
      "residual {:.2f} mm RMS during the motion; the model is healthy below {:.2f} mm and unfit above {:.2f} "
      "mm",
      motion.residual_rms_mm, healthy_mm, health.unfit_mm);
  const std::string name = "model " + channel.name;
  if (motion.residual_rms_mm > health.unfit_mm) {
    findings.fail(name, text,
                  "the cause may be a replaced finger, wear, a leak or a moved sensor: inspect the finger, "
                  "calibrate the sensor, then identify the model again");
  } else if (motion.residual_rms_mm > healthy_mm) {
    findings.warn(name, text,
                  "the detection of a grip becomes less reliable: record the test signal tp1 and identify "
                  "the model again soon");
  } else {
    findings.ok(name, text);
  }
}

}  // namespace

MotionSession::Expected<Motion> move_and_watch(const rig::RigFile& rig, MotionSession& session,
                                               std::size_t channel, const ChannelSample& rest,
                                               const MoveSettings& settings) {
  const control::ChannelSettings& of = rig.settings.channels[channel];
  const double rest_kpa = control::resting_kpa(of.limits);
  const double step = settings.share * (control::far_end_kpa(of.limits) - rest_kpa);
  const double speed = std::abs(step) / settings.duration_s;
  Beside beside(of, seconds(session.period()), rest.displacement_mm.mean);
  const MotionSession::Watch watch = [&](const std::vector<double>& commands,
                                         const std::vector<model::Reading>& readings) {
    beside.take(readings[channel], commands[channel]);
  };
  Motion motion;
  motion.command_kpa = rest_kpa + step;
  if (const auto up = session.ramp(channel, motion.command_kpa, speed, watch); !up)
    return tl::unexpected(up.error());
  const auto settling = session.sample(settings.settle_s / 2, watch);
  if (!settling) return tl::unexpected(settling.error());
  beside.begin_mean();
  const auto there = session.sample(settings.settle_s / 2, watch);
  if (!there) return tl::unexpected(there.error());
  motion.up = *there;
  motion.model_mm = beside.mean_mm();
  if (const auto down = session.ramp(channel, rest_kpa, speed, watch); !down)
    return tl::unexpected(down.error());
  const auto after = session.sample(settings.settle_s, watch);
  if (!after) return tl::unexpected(after.error());
  motion.residual_rms_mm = beside.rms_mm();
  return motion;
}

bool has_moved(const Sample& rest, const Sample& seen, double model_mm) {
  const double least_mm = std::max(noises * rest.deviation, share_of_model * std::abs(model_mm));
  return std::abs(seen.mean - rest.mean) >= least_mm;
}

namespace {

/// Checks that the pressure follows the command. If it does not, returns false, and the caller omits all
/// checks that depend on the pressure.
bool judge_valve(const control::ChannelSettings& of, const Sample& monitor, double command_kpa,
                 Findings& findings) {
  const double step_kpa = std::abs(command_kpa - control::resting_kpa(of.limits));
  const std::string text =
      fmt::format("{:.2f} kPa commanded, {:.2f} kPa measured", command_kpa, monitor.mean);
  const double allowed_kpa = std::max(allowed_share_of_step * step_kpa, pressure_floor_kpa);
  const bool follows = std::abs(monitor.mean - command_kpa) <= allowed_kpa;
  if (follows) {
    findings.ok("valve " + of.name, text);
  } else {
    findings.fail("valve " + of.name, text,
                  "check for missing supply pressure, missing power of the valve, leaks and kinked lines. If "
                  "none of these is the cause, calibrate the valve and the pressure monitor");
  }
  return follows;
}

void judge_finger(const control::ChannelSettings& of, const Sample& rest, const Sample& seen,
                  const Motion& motion, bool pressure_seen, Findings& findings) {
  const double moved_mm = seen.mean - rest.mean;
  const std::string name = "finger " + of.name;
  const std::string text =
      fmt::format("the finger moved {:.2f} mm at {:.1f} kPa; the model predicts {:.2f} mm", moved_mm,
                  motion.command_kpa, motion.model_mm);
  const auto broken = [&](const std::string& what, const std::string& advice) {
    findings.fail(name, what, advice);
    findings.not_judged("model " + of.name, "see `" + name + "`");
  };
  if (seen.invalid > 0) {
    broken(fmt::format("invalid readings during the motion: {}", daemon::name_of(seen.why)),
           "the finger leaves the range of the sensor, or the beam of the sensor is interrupted");
  } else if (!has_moved(rest, seen, motion.model_mm)) {
    broken(text, pressure_seen ? "the pressure is present: check for a stuck sensor, a burst finger, or a "
                                 "blocked air line between valve and finger"
                               : "no supply pressure, a blocked air line or a stuck sensor: move the finger "
                                 "by hand and watch the reading");
  } else if (moved_mm * motion.model_mm < 0) {
    broken(text, "the reading changes in the direction opposite to the prediction: calibrate the sensor");
  } else {
    findings.ok(name, text);
    judge_model(of, motion, findings);
  }
}

}  // namespace

void judge_motion(const rig::RigFile& rig, std::size_t channel, const ChannelSample& rest,
                  const Motion& motion, const NotJudged& known, Findings& findings) {
  const control::ChannelSettings& of = rig.settings.channels[channel];
  const Sample& monitor = motion.up[channel].pressure_kpa;
  std::string finger_waits = known.finger;
  bool pressure_seen = false;
  if (!known.valve.empty()) {
    findings.not_judged("valve " + of.name, known.valve);
  } else if (monitor.count == 0) {
    findings.ok("valve " + of.name,
                "the pressure was not measured, because the channel has no pressure monitor; see the finding "
                "about the motion");
  } else {
    pressure_seen = judge_valve(of, monitor, motion.command_kpa, findings);
    if (!pressure_seen && finger_waits.empty()) finger_waits = "see `valve " + of.name + "`";
  }
  if (!of.displacement_used) return;
  if (!finger_waits.empty()) {
    findings.not_judged("finger " + of.name, finger_waits);
    findings.not_judged("model " + of.name, finger_waits);
    return;
  }
  judge_finger(of, rest.displacement_mm, motion.up[channel].displacement_mm, motion, pressure_seen, findings);
}

}  // namespace softgrip::tools::doctor
