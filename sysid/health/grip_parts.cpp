#include "sysid/health/grip_score.h"

#include <algorithm>
#include <cmath>

#include "sysid/limits/limits.h"

namespace softgrip::sysid::health {
namespace {

constexpr double moving_share = 0.005;
/// Distance by which the reading must be below the reading at contact, so that the finger counts as clear of
/// the object. It is the larger of a share of the displacement at full pressure and a share of the reading at
/// contact. The distance is necessary for two reasons: a contact is reported some time after the finger has
/// touched the object, and a released finger leaves the object at an unknown displacement.
constexpr double away_share_of_full = 0.05;
constexpr double away_share = 0.1;

double away_from(double touch_mm, double full_mm) {
  return touch_mm - std::max(away_share_of_full * full_mm, away_share * touch_mm);
}

/// Phase of the grip of one channel between two events.
enum class Phase : std::uint8_t { free, touching, holding, releasing, lost };

Phase after(const RecordedEvent& event, Phase phase) {
  if (event.kind == "fault_latched") return Phase::lost;
  if (event.kind == "contact" && phase == Phase::free) return Phase::touching;
  if (event.kind != "grip_result") return phase;
  if (event.code == "HOLDING") return phase == Phase::lost ? phase : Phase::holding;
  if (event.code == "RELEASED" || event.code == "NO PART")
    return phase == Phase::free || phase == Phase::lost ? phase : Phase::releasing;
  return Phase::lost;
}

/// Returns the time from which it is uncertain that the samples before HOLDING are free motion [s]. If a
/// contact was reported before `holding_s`, returns `holding_s`. Otherwise returns the start of the step that
/// ended in HOLDING.
double unsure_from(const std::vector<RecordedEvent>& events, const std::string& channel, double holding_s) {
  double step_s = 0;
  for (const RecordedEvent& event : events) {
    if (event.kind == "contact" && event.channel == channel && event.time_s < holding_s) return holding_s;
    if (event.kind == "step_started" && event.time_s < holding_s) step_s = event.time_s;
  }
  return step_s;
}

void note_times(const std::vector<RecordedEvent>& events, const std::string& channel, GripParts& parts) {
  const auto first = [](double& time, const RecordedEvent& event) {
    if (!std::isfinite(time)) time = event.time_s;
  };
  for (const RecordedEvent& event : events) {
    if (event.kind == "step_started") first(parts.began_s, event);
    if (event.channel != channel) continue;
    if (event.kind == "contact") first(parts.contact_s, event);
    if (event.kind == "grip_result" && event.code == "HOLDING") first(parts.holding_s, event);
  }
}

/// Returns the last valid reading up to sample i.
double last_reading(const sysid::Log& log, std::size_t i) {
  while (i > 0 && !std::isfinite(log.displacement_mm[i])) --i;
  return log.displacement_mm[i];
}

/// Marks samples before a contact as `neither`. The marked range starts after the last sample at which the
/// finger was clear of the object.
void forget_approach(const sysid::Log& log, double contact_s, double full_mm, std::vector<Part>& at) {
  std::size_t i = 0;
  while (i + 1 < log.size() && log.time_s[i] < contact_s) ++i;
  const double away = away_from(last_reading(log, i), full_mm);
  for (; i > 0 && at[i - 1] == Part::free && !(log.displacement_mm[i - 1] < away); --i)
    at[i - 1] = Part::neither;
}

/// Assigns each sample of one channel to a part of the grip. The samples must be passed in order of time. The
/// events of the channel determine the parts.
class Walk {
 public:
  Walk(const Recording& recording, const sysid::Log& log, double full_kpa, double full_mm)
      : events_(recording.events), log_(log), full_kpa_(full_kpa), full_mm_(full_mm) {}

  /// Returns the part of the grip to which sample i belongs. Must be called for all samples in order. Samples
  /// from `unsure_s` to `holding_s` are `neither`.
  [[nodiscard]] Part next(std::size_t i, double predicted_mm, double unsure_s, double holding_s) {
    const double t = log_.time_s[i];
    for (; event_ < events_.size() && events_[event_].time_s <= t; ++event_) {
      const RecordedEvent& event = events_[event_];
      if (!event.channel.empty() && event.channel != log_.channel) continue;
      const Phase before = phase_;
      phase_ = after(event, phase_);
      if (phase_ == Phase::touching && before == Phase::free) touch_mm_ = last_reading(log_, i);
      if (phase_ == Phase::holding && before != Phase::holding) held_kpa_ = log_.pressure_command_kpa[i];
    }
    const double command_kpa = log_.pressure_command_kpa[i];
    if (phase_ == Phase::holding &&
        std::abs(command_kpa - held_kpa_) > limits::constant_command_share * full_kpa_)
      phase_ = Phase::releasing;
    if (phase_ == Phase::releasing &&
        is_away(std::isfinite(touch_mm_) ? log_.displacement_mm[i] : predicted_mm))
      phase_ = Phase::free;
    moved_ = moved_ || command_kpa > log_.pressure_command_kpa.front() + moving_share * full_kpa_;
    if (phase_ == Phase::holding) return Part::held;
    if (phase_ != Phase::free || (t >= unsure_s && t < holding_s)) return Part::neither;
    return moved_ ? Part::free : Part::rest;
  }

 private:
  [[nodiscard]] bool is_away(double mm) const {
    return mm < (std::isfinite(touch_mm_) ? away_from(touch_mm_, full_mm_) : away_share_of_full * full_mm_);
  }

  const std::vector<RecordedEvent>& events_;
  const sysid::Log& log_;
  double full_kpa_, full_mm_;
  std::size_t event_ = 0;
  Phase phase_ = Phase::free;
  double touch_mm_ = std::numeric_limits<double>::quiet_NaN();
  double held_kpa_ = 0;
  bool moved_ = false;
};

}  // namespace

GripParts parts_of(const Recording& recording, std::size_t channel, const std::vector<double>& predicted_mm,
                   double full_kpa, double full_mm) {
  const sysid::Log& log = recording.channels[channel];
  GripParts parts;
  note_times(recording.events, log.channel, parts);
  const double never = std::numeric_limits<double>::infinity();
  const bool gripped = std::isfinite(parts.holding_s);
  const double unsure_s = gripped ? unsure_from(recording.events, log.channel, parts.holding_s) : never;
  Walk walk(recording, log, full_kpa, full_mm);
  for (std::size_t i = 0; i < log.size(); ++i)
    parts.at.push_back(walk.next(i, predicted_mm[i], unsure_s, gripped ? parts.holding_s : never));
  for (const RecordedEvent& event : recording.events) {
    if (event.kind == "contact" && event.channel == log.channel)
      forget_approach(log, event.time_s, full_mm, parts.at);
  }
  return parts;
}

}  // namespace softgrip::sysid::health
