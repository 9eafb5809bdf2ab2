#pragma once
// One finger in one tick: reading and reference in, command out. Feedforward plus PID through the limits,
// with the model running alongside on the command that was really sent.

#include <cstddef>
#include <cstdint>
#include <memory>

#include "control/elements/model_health.h"
#include "control/tick/channel_demand.h"
#include "control/tick/channel_settings.h"
#include "model/reading.h"

namespace softgrip::control {

struct ChannelInput {
  Nanoseconds now = 0;     ///< the tick's place on the grid
  model::Reading reading;  ///< as the driver gave it
  ChannelDemand demand;    ///< what the player or the supervisor asks
  /// Follow the finger to where it is: the difference between reading and model becomes the model's offset.
  /// Only at rest, before motion starts; see ChannelStep::synchronised.
  bool resynchronise = false;
  /// The finger moves without touching anything, as far as is known: only then is the residual the model's.
  bool free_motion = true;
};

/// What one tick gave. Every field is that of this tick.
struct ChannelStep {
  double command_kpa = 0;      ///< clamped and slew-limited: what goes to the board
  double feedforward_kpa = 0;  ///< 0 outside mode displacement
  double feedback_kpa = 0;     ///< 0 outside mode displacement
  double reference_mm = 0;     ///< clamped, for now; NaN outside mode displacement
  double displacement_mm = 0;  ///< the reading used: the last valid one
  double residual_mm = 0;      ///< reading minus (model + offset), both at the time the reading was sampled;
                               ///< NaN while there is no valid reading
  double age_s = 0;            ///< of the reading
  model::Validity validity = model::Validity::none_yet;

  bool saturated = false;            ///< the request was outside the pressure range
  bool slewing = false;              ///< the request was further away than the slew limits allow
  bool request_invalid = false;      ///< the request was not a number: the command was held
  bool reference_clamped = false;    ///< the reference was outside the displacement range
  bool out_of_reach = false;         ///< the feedforward cannot reach the reference within the limits
  bool displacement_beyond = false;  ///< the reading is beyond the displacement range and its margin
  bool synchronised = false;         ///< resynchronise was asked and residual_mm has settled

  HealthState health = HealthState::unknown;
  bool health_changed = false;
  double health_rms_mm = 0;  ///< root mean square of the residual, by which a model is unfit
};

/// Settings must hold what their headers say, and check_feedforward() (control/feedforward/invertibility.h)
/// must have accepted model and feedforward; otherwise the feedforward is none.
class ChannelController {
 public:
  ChannelController(const ChannelSettings& settings, double tick_s);
  ChannelController(ChannelController&&) noexcept;
  ChannelController& operator=(ChannelController&&) noexcept;
  ~ChannelController();

  /// Starts from rest with `command_kpa` at the board (the safe output of the phase idle, clamped).
  void start(double command_kpa) noexcept;

  /// One period. Calls that are more than one period apart (slipped ticks) make the model catch up.
  [[nodiscard]] ChannelStep tick(const ChannelInput& input) noexcept;

  /// The command of the last tick.
  [[nodiscard]] double command_kpa() const noexcept;
  /// How far ahead of now the feedforward asks the reference. A reference that changes its mind does so
  /// without a step when it is cut at now + preview_s().
  [[nodiscard]] double preview_s() const noexcept;
  /// Where the free finger would be by the model, offset included, with the commands sent so far, at the
  /// time of the last reading.
  [[nodiscard]] double free_displacement_mm() const noexcept;
  /// What resynchronising added to the model [mm].
  [[nodiscard]] double offset_mm() const noexcept;

  /// New gains without a step of the command.
  void change_gains(const PidSettings& settings) noexcept;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace softgrip::control
