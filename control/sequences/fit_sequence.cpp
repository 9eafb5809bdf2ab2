#include "control/sequences/sequence_plans.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "base/numbers.h"
#include "control/feedforward/free_curve.h"
#include "document/node.h"

namespace softgrip::control {

namespace {

using document::Problems;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Smallest permitted ratio of a gripping pressure to the gripping pressure that causes a displacement
/// shortfall of margin_mm. With a smaller ratio, noise could hide a part.
constexpr double seen_from = 1.2;

double rounded(double value) {
  return std::round(value * 100) / 100;
}

class Fitting {
 public:
  Fitting(const Sequence& sequence, const RigSettings& settings, Problems& problems)
      : sequence_(sequence), settings_(settings), problems_(problems) {
    source_.file = sequence.file;
    source_.text = sequence.text;
  }

  PreparedSequence run() {
    PreparedSequence result;
    result.name = sequence_.name;
    result.interlock = sequence_.interlock;
    result.rig = rig_key(settings_);
    for (const Parameter& parameter : sequence_.parameters) {
      result.parameters.push_back({parameter.name, parameter.value});
    }
    const std::uint32_t all = mask_of(sequence_.channels, {}, (1U << settings_.channels.size()) - 1);
    for (const Step& step : sequence_.steps) {
      PreparedStep prepared{.step = step, .channels = mask_of(step.channels, step.at, all), .plans = {}};
      if ((prepared.channels & ~all) != 0) {
        report(step, "names a channel that the sequence does not use");
      }
      check(step, prepared.channels);
      result.channels |= prepared.channels;
      if (step.kind == StepKind::grip && step.verify.by == VerifyBy::detection) {
        result.needs_detection |= prepared.channels;
      }
      result.steps.push_back(std::move(prepared));
    }
    point_ahead(result.steps);
    return result;
  }

  void plan(PreparedSequence& prepared, const std::stop_token& stop) {
    for (const MissedPlan& missed : plan_steps(prepared, settings_, stop)) {
      const Step& step = sequence_.steps[missed.step];
      problems_.warn(source_.problem(
          step.at,
          "step '" + step.name + "': the model of channel '" + settings_.channels[missed.channel].name +
              "' cannot follow the reference within the pressure and slew limits: "
              "the displacement deviates by up to " +
              significant(rounded(missed.worst_mm), 6) + " mm from the reference",
          "use a slower or smaller motion, or widen the pressure and slew limits"));
    }
    if (stop.stop_requested())
      report(sequence_.steps.front(), "the planning of this step was stopped before its end");
    if (prepared.planned_s > most_planned_s) {
      report(sequence_.steps.front(),
             "more than " + significant(most_planned_s, 6) +
                 " s of motion would have to be planned before the start of the sequence",
             "split the sequence, or use a feedforward other than `planned`");
    }
  }

 private:
  void report(const Step& step, const std::string& message, std::string hint = {}) {
    problems_.add(source_.problem(step.at, "step '" + step.name + "': " + message, std::move(hint)));
  }

  std::uint32_t mask_of(const std::vector<std::string>& names, document::Location at,
                        std::uint32_t if_empty) {
    if (names.empty()) return if_empty;
    std::uint32_t mask = 0;
    std::vector<std::string> known;
    for (const ChannelSettings& channel : settings_.channels) known.push_back(channel.name);
    for (const std::string& name : names) {
      const auto found = std::find(known.begin(), known.end(), name);
      if (found == known.end()) {
        const std::string near = document::nearest(name, known);
        problems_.add(source_.problem(at, "the rig has no channel '" + name + "'",
                                      near.empty() ? "" : "did you mean '" + near + "'?"));
      } else {
        mask |= 1U << (found - known.begin());
      }
    }
    return mask;
  }

  void check(const Step& step, std::uint32_t channels) {
    for (std::size_t i = 0; i < settings_.channels.size(); ++i) {
      if ((channels >> i & 1U) != 0) check_channel(step, settings_.channels[i], i);
    }
    check_times(step);
    if (step.on_contact == OnContact::grip && !is_before_a_grip(step)) {
      report(step, "`on_contact: grip` requires a grip step after this step", "on_contact: hold");
    }
    if (step.kind == StepKind::grip) {
      gripped_ |= channels;
    } else if (step.kind == StepKind::hold && (gripped_ & channels) == 0) {
      report(step, "a hold step requires an earlier grip step of at least one of its channels",
             "put a grip step before the hold step");
    }
  }

  void check_channel(const Step& step, const ChannelSettings& channel, std::size_t index) {
    double& follows = follows_mm_[index];
    switch (step.kind) {
      case StepKind::track:
        check_track(step, channel, follows);
        break;
      case StepKind::pressure:
        check_profile(step, channel);
        follows = unknown;
        break;
      case StepKind::move:
      case StepKind::grip:
      case StepKind::release:
        check_target(step, channel);
        follows = step.target.quantity == Target::Quantity::displacement_mm ? step.target.value : unknown;
        break;
      case StepKind::hold:
        break;
    }
    if (step.kind == StepKind::grip) check_verify(step, channel);
    check_side(step, channel);
    check_bounds(step, channel, index);
  }

  [[nodiscard]] bool is_before_a_grip(const Step& step) const {
    const auto behind = sequence_.steps.begin() + (&step - sequence_.steps.data());
    return std::any_of(behind, sequence_.steps.end(),
                       [](const Step& other) { return other.kind == StepKind::grip; });
  }

  void check_bounds(const Step& step, const ChannelSettings& channel, std::size_t index) {
    const double most_kpa = step.bounds.pressure_max_kpa;
    if (std::isfinite(most_kpa)) {
      check_pressure(step, channel, most_kpa, most_kpa);
      const double rest_kpa = resting_kpa(channel.limits);
      if (most_kpa < rest_kpa) {
        report(step, "pressure_max_kpa of the step is below the rest pressure of channel '" + channel.name +
                         "' (" + significant(rest_kpa, 6) +
                         " kPa), but every step must permit the rest pressure");
      }
      const bool by_pressure = step.target.quantity == Target::Quantity::pressure_kpa &&
                               (step.kind == StepKind::move || step.kind == StepKind::grip);
      if (by_pressure && step.target.value > most_kpa) {
        report(step, "goes to " + significant(step.target.value, 6) +
                         " kPa, above the pressure_max_kpa of the step");
      }
    }
    if (!std::isfinite(step.bounds.squeeze_max_kpa)) return;
    if (!channel.displacement_used) {
      report(step,
             "channel '" + channel.name +
                 "' does not use its displacement sensor, so the gripping pressure is unknown",
             "limit the step with pressure_max_kpa instead of squeeze_max_kpa");
    } else if (step.kind == StepKind::grip && step.verify.by == VerifyBy::detection) {
      check_squeeze(step, channel, index);
    }
  }

  /// Reports a grip whose permitted gripping pressure is too low to detect a part. Such a grip would never
  /// have the result HOLDING.
  void check_squeeze(const Step& step, const ChannelSettings& channel, std::size_t index) {
    std::optional<double>& least_kpa = least_squeeze_kpa_[index];
    if (!least_kpa) {
      least_kpa = FreeCurve(channel.model, channel.limits).squeeze_for_kpa(settings_.detection.margin_mm);
    }
    const bool squeezes = step.squeeze.by_kpa > 0;
    const double by_kpa = squeezes ? step.squeeze.by_kpa : step.bounds.squeeze_max_kpa;
    const double needed_kpa = std::ceil(10 * seen_from * *least_kpa) / 10;
    if (by_kpa >= needed_kpa) return;
    report(step,
           "grips with " + significant(by_kpa, 6) + " kPa, but channel '" + channel.name +
               "' detects a part only if the gripping pressure is at least " + significant(needed_kpa, 6) +
               " kPa",
           "increase " + std::string(squeezes ? "squeeze_kpa" : "squeeze_max_kpa") +
               ", or reduce margin_mm under `detection` in the rig file");
  }

  void check_target(const Step& step, const ChannelSettings& channel) {
    if (step.target.quantity == Target::Quantity::displacement_mm) {
      check_displacement(step, channel, step.target.value, step.target.value);
    } else if (!step.target.at_rest) {
      check_pressure(step, channel, step.target.value, step.target.value);
    }
  }

  struct Range {
    double lowest = infinite;
    double highest = -infinite;
  };

  void check_range(const Step& step, const ChannelSettings& channel, const Range& values,
                   const Range& permitted, const std::string& unit) {
    if (values.lowest >= permitted.lowest && values.highest <= permitted.highest) return;
    const double wrong = values.lowest < permitted.lowest ? values.lowest : values.highest;
    report(step, "goes to " + significant(wrong, 6) + unit + ", channel '" + channel.name + "' allows " +
                     significant(permitted.lowest, 6) + " to " + significant(permitted.highest, 6) + unit);
  }

  void check_displacement(const Step& step, const ChannelSettings& channel, double lowest, double highest) {
    check_range(step, channel, {lowest, highest},
                {channel.limits.displacement_min_mm, channel.limits.displacement_max_mm}, " mm");
    if (!channel.displacement_used) {
      report(step, "channel '" + channel.name + "' does not use its displacement",
             "give the target in pressure_kpa");
    } else if (channel.feedforward.kind == FeedforwardKind::none && channel.pid.kp_kpa_per_mm == 0 &&
               channel.pid.ki_kpa_per_mm_s == 0) {
      report(step, "channel '" + channel.name +
                       "' has no feedforward and no PID gains, but a target in displacement_mm requires at "
                       "least one of them");
    }
  }

  void check_pressure(const Step& step, const ChannelSettings& channel, double lowest, double highest) {
    check_range(step, channel, {lowest, highest},
                {channel.limits.pressure_min_kpa, channel.limits.pressure_max_kpa}, " kPa");
  }

  void check_track(const Step& step, const ChannelSettings& channel, double& follows) {
    const Sine& sine = step.sine;
    const double start = sine.mean_mm - sine.amplitude_mm;
    check_displacement(step, channel, start, sine.mean_mm + sine.amplitude_mm);
    if (!(std::abs(follows - start) < 1e-9)) {
      report(step, "starts at " + significant(start, 6) + " mm (mean_mm - amplitude_mm)",
             "put a move to displacement_mm: " + significant(start, 6) + " before it");
    }
    if (sine.frequency_hz > settings_.rate_hz / 20) {
      report(step, "frequency_hz is above 1/20 of the rig's rate_hz");
    }
    follows = start;
  }

  static Range range_of(const Profile& profile) {
    Range range;
    const auto see = [&](double value) {
      range.lowest = std::min(range.lowest, value);
      range.highest = std::max(range.highest, value);
    };
    if (profile.signal) {
      constexpr int samples = 2000;
      for (int i = 0; i <= samples; ++i) see(value_at(profile, cycle_s(profile) * i / samples));
    }
    for (const Point& point : profile.points) see(point.pressure_kpa);
    return range;
  }

  void check_profile(const Step& step, const ChannelSettings& channel) {
    const Range range = range_of(step.profile);
    check_pressure(step, channel, range.lowest, range.highest);
  }

  void check_verify(const Step& step, const ChannelSettings& channel) {
    if (step.verify.by == VerifyBy::pressure) {
      if (!channel.pressure_measured) {
        report(step, "verifies the grip by its pressure, but channel '" + channel.name +
                         "' does not measure the pressure");
      }
      check_pressure_bound(step, channel);
    } else if (!channel.displacement_used) {
      report(step, "channel '" + channel.name + "' does not use its displacement", "verify by: pressure");
    }
  }

  /// Reports a pressure bound of a grip that the finger already meets at the rest pressure. Such a bound
  /// cannot verify the grip.
  void check_pressure_bound(const Step& step, const ChannelSettings& channel) {
    const bool below = step.verify.below();
    const double bound_kpa = below ? step.verify.pressure_max_kpa : step.verify.pressure_min_kpa;
    check_pressure(step, channel, bound_kpa, bound_kpa);
    const double rest_kpa = resting_kpa(channel.limits);
    const bool rest_passes =
        below ? rest_kpa <= bound_kpa : rest_kpa >= bound_kpa && channel.limits.pressure_min_kpa < rest_kpa;
    if (!rest_passes) return;
    report(step,
           "verifies the grip by a pressure that channel '" + channel.name +
               "' already has at rest, without a grip (" + significant(rest_kpa, 6) + " kPa)",
           below ? "use a lower pressure_max_kpa"
                 : "use pressure_max_kpa if the grip uses a pressure below the rest pressure");
  }

  /// Reports a step that uses detection, on_contact or squeeze_kpa at pressures below the rest pressure.
  /// These three functions detect a part only if the finger moves upward from rest.
  void check_side(const Step& step, const ChannelSettings& channel) {
    const double rest_kpa = resting_kpa(channel.limits);
    const bool detects = step.kind == StepKind::grip && step.verify.by == VerifyBy::detection;
    const bool touches = step.on_contact_stated && step.on_contact != OnContact::ignore;
    const bool compares = detects || touches || step.squeeze.by_kpa > 0;
    if (!compares || channel.limits.pressure_min_kpa >= rest_kpa || highest_kpa(step, channel) >= rest_kpa) {
      return;
    }
    report(
        step,
        "moves channel '" + channel.name + "' below its rest pressure (" + significant(rest_kpa, 6) +
            " kPa), where detection, on_contact and squeeze_kpa cannot detect a part",
        step.kind == StepKind::grip
            ? "use `by: position` under `verify`, or `by: pressure` with pressure_max_kpa. Remove squeeze_kpa"
            : "on_contact: ignore");
  }

  /// Returns the highest pressure of a step. For a step to a displacement, the highest pressure is the
  /// command of the free curve for this displacement.
  static double highest_kpa(const Step& step, const ChannelSettings& channel) {
    if (step.kind == StepKind::pressure) return range_of(step.profile).highest;
    const bool track = step.kind == StepKind::track;
    if (!track && step.target.quantity == Target::Quantity::pressure_kpa) return step.target.value;
    return FreeCurve(channel.model, channel.limits)
        .command_kpa(track ? step.sine.mean_mm + step.sine.amplitude_mm : step.target.value);
  }

  void check_times(const Step& step) {
    const double period = 1 / settings_.rate_hz;
    if (step.kind == StepKind::grip && step.verify.window_s < 2 * period) {
      report(step, "window_s is shorter than two periods of the control loop");
    }
    if (step.kind == StepKind::hold && step.reverify_every_s < 2 * period) {
      report(step, "reverify_every_s is shorter than two periods of the control loop");
    }
    const double least = step.target.duration_s + step.settle_s + step.purge_s +
                         (step.kind == StepKind::grip ? step.verify.window_s : 0);
    if (step.timeout_s && *step.timeout_s <= least) {
      report(step,
             "timeout_s must exceed the sum of duration_s, settle_s, purge_s and window_s of the step, " +
                 significant(least, 6) + " s");
    }
  }

  static void point_ahead(std::vector<PreparedStep>& steps) {
    const auto nowhere = static_cast<std::uint16_t>(steps.size());
    std::uint16_t release = nowhere;
    std::uint16_t grip = nowhere;
    for (std::size_t i = steps.size(); i-- > 0;) {
      steps[i].release_step = release;
      steps[i].grip_step = grip;
      if (steps[i].step.kind == StepKind::release) release = static_cast<std::uint16_t>(i);
      if (steps[i].step.kind == StepKind::grip) grip = static_cast<std::uint16_t>(i);
    }
  }

  const Sequence& sequence_;
  const RigSettings& settings_;
  Problems& problems_;
  document::Document source_;
  std::uint32_t gripped_ = 0;
  /// For each channel, the smallest gripping pressure with which a part is detected; empty until it is
  /// computed.
  std::vector<std::optional<double>> least_squeeze_kpa_ =
      std::vector<std::optional<double>>(settings_.channels.size());
  /// For each channel, the displacement reference at the end of the previous step; NaN if the channel follows
  /// no displacement.
  std::vector<double> follows_mm_ = std::vector<double>(settings_.channels.size(), unknown);
};

}  // namespace

PreparedSequence fit_to_rig(const Sequence& sequence, const RigSettings& settings,
                            document::Problems& problems) {
  return Fitting(sequence, settings, problems).run();
}

void plan_motion(const Sequence& sequence, const RigSettings& settings, PreparedSequence& prepared,
                 document::Problems& problems, const std::stop_token& stop) {
  Fitting(sequence, settings, problems).plan(prepared, stop);
}

}  // namespace softgrip::control
