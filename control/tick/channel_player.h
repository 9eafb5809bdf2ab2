#pragma once
// Executes the steps of a sequence for one channel, one step at a time.

#include <cstdint>
#include <optional>

#include "control/elements/follow_watch.h"
#include "control/elements/grip_detector.h"
#include "control/elements/grip_result.h"
#include "control/elements/reference.h"
#include "control/tick/channel_demand.h"
#include "control/tick/sequence.h"
#include "control/tick/tick.h"

namespace softgrip::control {

/// The progress of a channel in its present step.
enum class Progress : std::uint8_t { pending, passed, failed };

/// Properties of a channel that do not change.
struct ChannelTraits {
  double margin_mm = 0;           ///< margin of grip detection
  double rest_kpa = 0;            ///< rest pressure of the channel
  double preview_s = 0;           ///< time by which the feedforward reads the reference ahead of now
  bool displacement_used = true;  ///< true: the displacement sensor of the channel is used
};

/// Executes the steps of a sequence for one channel. In all functions, `seen` is the output of the channel in
/// the last tick.
class ChannelPlayer {
 public:
  explicit ChannelPlayer(const ChannelTraits& traits) noexcept
      : traits_(traits), contact_(traits.margin_mm) {}

  /// Prepares the first step of a sequence: keeps the command, assumes no contact, and clears the last
  /// result.
  void reset() noexcept;
  /// Starts an attempt at a step. `step` and `plan` must exist until the attempt ends; `plan` is nullptr if
  /// there is no plan. A hold step continues with the plan of the previous step.
  void begin(const Step& step, const PressurePlan* plan, double time_s, const ChannelOutput& seen) noexcept;
  /// Moves the channel back to the displacement or pressure at which the attempt began. The return has the
  /// speed or the duration that the step specifies.
  void back_off(double time_s, const ChannelOutput& seen) noexcept;
  /// Executes a tick of the step, or of the return that back_off() has started. During a return, the result
  /// `passed` means that the return is finished.
  Progress tick(double time_s, const ChannelOutput& seen) noexcept;
  /// Executes a tick while no sequence runs. Returns true in the tick in which the loss of a held part is
  /// detected.
  bool idle(double time_s, const ChannelOutput& seen) noexcept;

  /// Returns the demand of the last tick. The member `reference` of the demand points to a member of this
  /// object.
  [[nodiscard]] ChannelDemand demand(double time_s) const noexcept;
  /// Returns true if the finger is in contact with an object.
  [[nodiscard]] bool touching() const noexcept { return contact_.touching(); }
  /// Returns true if the finger moves less than its model because an object blocks the finger.
  [[nodiscard]] bool held_back() const noexcept { return follow_.held(); }
  /// Returns the action for a contact that occurred during the motion, once for each contact. Returns nothing
  /// if no new contact has occurred.
  [[nodiscard]] std::optional<OnContact> take_contact() noexcept;
  /// Returns true if the finger stays at the pressure of its first contact with an object.
  [[nodiscard]] bool stopped_by_contact() const noexcept { return stopped_by_contact_; }
  /// Returns the grip result of the channel for a step that fails in this tick: NO PART or ERROR.
  [[nodiscard]] GripResult failure() const noexcept { return failure_; }

  [[nodiscard]] GripResult result() const noexcept { return result_; }
  [[nodiscard]] GripEvidence evidence() const noexcept { return evidence_; }
  void answer(GripResult result, GripEvidence evidence) noexcept;
  /// Sets the result HOLDING after a verified grip. From then on, the grip is monitored with the criterion of
  /// the step.
  void answer_holding(double time_s) noexcept;
  /// Returns the evidence that a verification by the criterion `by` uses.
  [[nodiscard]] GripEvidence evidence_of(VerifyBy by) const noexcept;
  /// Returns the displacement shortfall in the last tick [mm]: the displacement of free motion minus the
  /// reading. Returns NaN if the shortfall is unknown.
  [[nodiscard]] double shortfall_mm() const noexcept { return shortfall_mm_; }

  /// Keeps the present command from now on.
  void freeze() noexcept {
    mode_ = ChannelDemand::Mode::hold;
    plan_ = nullptr;
    profile_ = squeezing_ = false;
  }
  /// Returns the time at which the ramp or the profile of the present step ends.
  [[nodiscard]] double motion_end_s() const noexcept {
    return stage_ == Stage::profile ? stage_end_s_ : ramp_end_s_;
  }
  /// Returns the pressure that the present step commands at `time_s` in mode pressure [kPa].
  [[nodiscard]] double pressure_at(double time_s) const noexcept;

 private:
  enum class Stage : std::uint8_t {
    ramp,
    squeeze,
    settle,
    verify,
    watch,
    purge,
    free,
    profile,
    back,
    failed,
    done,
  };

  [[nodiscard]] bool begin_track(const Sine& sine, double time_s, const ChannelOutput& seen) noexcept;
  double go_to(const Target& target, double value, double time_s, const ChannelOutput& seen) noexcept;
  void feel(const ChannelOutput& seen, bool watched) noexcept;
  bool watch(double time_s, const ChannelOutput& seen) noexcept;
  void look_for_contact(double time_s, const ChannelOutput& seen) noexcept;
  [[nodiscard]] OnContact on_contact() const noexcept;
  [[nodiscard]] bool under_way() const noexcept;
  Progress stopped(const ChannelOutput& seen) noexcept;
  void stay_at(double pressure_kpa, double time_s) noexcept;
  void begin_squeeze(double time_s, const ChannelOutput& seen) noexcept;
  [[nodiscard]] bool squeezes_on(double time_s, const ChannelOutput& seen) noexcept;
  [[nodiscard]] double squeezing_kpa(double time_s, const ChannelOutput& seen) const noexcept;
  Progress advance(double time_s, const ChannelOutput& seen) noexcept;
  Progress after_ramp(double time_s, const ChannelOutput& seen) noexcept;
  Progress settle(double time_s, const ChannelOutput& seen) noexcept;
  Progress verify(double time_s, const ChannelOutput& seen) noexcept;
  Progress release(double time_s) noexcept;
  Progress pass() noexcept;
  [[nodiscard]] bool valid(const ChannelOutput& seen) const noexcept;
  [[nodiscard]] bool usable(const Verify& verify, const ChannelOutput& seen) const noexcept;
  [[nodiscard]] bool evident(const Verify& verify, const ChannelOutput& seen) const noexcept;
  void take(const ChannelOutput& seen) noexcept;
  void watch_from(double time_s, double interval_s) noexcept;

  ChannelTraits traits_;
  const Step* step_ = nullptr;
  Stage stage_ = Stage::done;
  ChannelDemand::Mode mode_ = ChannelDemand::Mode::hold;
  Reference displacement_;  ///< reference for mode displacement [mm]
  Reference pressure_;      ///< reference for mode pressure [kPa]; not used for profiles
  const PressurePlan* plan_ = nullptr;
  double plan_origin_s_ = 0;
  double profile_start_s_ = 0;
  double pressure_kpa_ = 0;
  Target start_;  ///< displacement or pressure at which the step began; back_off() returns to it
  double ramp_end_s_ = 0;
  double stage_end_s_ = 0;
  double deadline_s_ = 0;
  double shortfall_mm_ = 0;
  bool within_ = false;   ///< true: the displacement is within the tolerance of the target
  Bounds bounds_;         ///< bounds of the step; in a hold, also the bounds of the previous step
  bool profile_ = false;  ///< true: the pressure follows the profile of the step
  bool closing_ = false;  ///< true: the step increases the displacement or the pressure, or it is a track or
                          ///< pressure step
  /// Start of the time in which two conditions have been true without interruption: the finger is in contact,
  /// and the command is at or above the rest pressure. Empty while a condition is false.
  std::optional<double> touching_since_s_;
  bool met_ = false;                      ///< true: a contact occurred in this attempt
  std::optional<OnContact> contact_met_;  ///< action for a contact that take_contact() has not returned yet
  bool stopped_by_contact_ = false;
  bool squeezing_ = false;       ///< true: the command is kept above the free-motion pressure by a fixed
                                 ///< gripping pressure
  double squeeze_from_kpa_ = 0;  ///< gripping pressure at the time squeeze_from_s_
  double squeeze_from_s_ = 0;
  Contact contact_;
  FollowWatch follow_;
  EvidenceWindow window_;
  bool verified_ = false;  ///< true: the grip was verified in this attempt
  HoldWatch hold_;
  Verify held_by_;  ///< criterion by which the holding of the part is monitored
  GripResult failure_ = GripResult::error;
  GripResult result_ = GripResult::none;
  GripEvidence evidence_ = GripEvidence::none;
};

}  // namespace softgrip::control
