// Implements the functions of ChannelPlayer (control/tick/channel_player.h) that react to contact and limit
// the pressure on an object.

#include <algorithm>
#include <utility>

#include "control/tick/channel_player.h"

namespace softgrip::control {

namespace {
/// Largest difference between the command and a lower target pressure at which the command counts as reduced
/// to the target [kPa].
constexpr double taken_back_kpa = 0.05;
/// A contact is accepted after it has lasted for this time [s]. Noise and a single wrong reading last for a
/// shorter time.
constexpr double contact_lasts_s = 0.02;
using Mode = ChannelDemand::Mode;
}  // namespace

std::optional<OnContact> ChannelPlayer::take_contact() noexcept {
  return std::exchange(contact_met_, std::nullopt);
}

OnContact ChannelPlayer::on_contact() const noexcept {
  if (step_->kind != StepKind::grip) return step_->on_contact;
  return step_->squeeze.by_kpa > 0 ? OnContact::squeeze : OnContact::close;
}

/// Returns true if the finger moves in a direction in which it can meet an object. Returns false for a finger
/// that holds a part, and for an opening finger, which moves away from the object.
bool ChannelPlayer::under_way() const noexcept {
  if (!closing_ || result_ == GripResult::holding) return false;
  return stage_ == Stage::ramp || (stage_ == Stage::settle && !squeezing_) || stage_ == Stage::profile;
}

void ChannelPlayer::look_for_contact(double time_s, const ChannelOutput& seen) noexcept {
  // Contact can be detected only while the command is at or above the rest pressure.
  if (!contact_.touching() || seen.command_kpa < traits_.rest_kpa) {
    touching_since_s_.reset();
    return;
  }
  if (!touching_since_s_) touching_since_s_ = time_s;
  if (met_ || !under_way() || time_s - *touching_since_s_ < contact_lasts_s) return;
  met_ = true;
  contact_met_ = on_contact();
  if (contact_met_ == OnContact::squeeze) {
    begin_squeeze(time_s, seen);
  } else if (contact_met_ != OnContact::ignore && contact_met_ != OnContact::close) {
    // At contact, a part of the commanded pressure has not reached the finger yet. Therefore, the command is
    // reduced to the pressure that the finger had at contact.
    const double touched_with_kpa = seen.free_kpa + std::max(0.0, seen.squeeze_kpa);
    stay_at(no_further(traits_.rest_kpa, touched_with_kpa, seen.command_kpa), time_s);
    stopped_by_contact_ = true;
  }
}

/// Waits until the command has been reduced to the pressure at contact. After that, the step fails if its
/// on_contact is `fail`. Otherwise, the step passes.
Progress ChannelPlayer::stopped(const ChannelOutput& seen) noexcept {
  if (seen.command_kpa > pressure_.final_value() + taken_back_kpa) return Progress::pending;
  return step_->on_contact == OnContact::fail ? Progress::failed : pass();
}

void ChannelPlayer::stay_at(double pressure_kpa, double time_s) noexcept {
  mode_ = Mode::pressure;
  plan_ = nullptr;
  squeezing_ = profile_ = false;
  pressure_.start(time_s, pressure_kpa);
}

void ChannelPlayer::begin_squeeze(double time_s, const ChannelOutput& seen) noexcept {
  const Squeeze& squeeze = step_->squeeze;
  stay_at(seen.command_kpa, time_s);
  squeezing_ = true;
  squeeze_from_s_ = time_s;
  squeeze_from_kpa_ = std::clamp(seen.command_kpa - seen.free_kpa, 0.0, squeeze.by_kpa);
  ramp_end_s_ = time_s + (squeeze.by_kpa - squeeze_from_kpa_) / squeeze.speed_kpa_per_s;
  stage_ = Stage::squeeze;
}

double ChannelPlayer::squeezing_kpa(double time_s, const ChannelOutput& seen) const noexcept {
  const Squeeze& squeeze = step_->squeeze;
  const double ramp_kpa = squeeze_from_kpa_ + squeeze.speed_kpa_per_s * (time_s - squeeze_from_s_);
  const bool by_pressure = step_->target.quantity == Target::Quantity::pressure_kpa;
  return std::min(std::max(seen.free_kpa + std::min(squeeze.by_kpa, ramp_kpa), traits_.rest_kpa),
                  by_pressure ? step_->target.value : infinite);
}

/// Continues the increase of the gripping pressure. Returns false if the contact is lost; the finger then
/// moves towards its target as before the contact. If the object yields until the finger reaches its target
/// displacement, the pressure stays constant.
bool ChannelPlayer::squeezes_on(double time_s, const ChannelOutput& seen) noexcept {
  const bool by_displacement = step_->target.quantity == Target::Quantity::displacement_mm;
  if (by_displacement && seen.displacement_mm >= step_->target.value) stay_at(pressure_kpa_, time_s);
  if (contact_.touching()) return true;
  met_ = squeezing_ = false;
  go_to(step_->target, step_->target.value, time_s, seen);
  stage_ = Stage::ramp;
  return false;
}

}  // namespace softgrip::control
