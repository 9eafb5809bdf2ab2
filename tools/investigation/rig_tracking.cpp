#include "tools/investigation/experiment_rig.h"

#include <cmath>

#include "base/numbers.h"
#include "control/feedforward/invertibility.h"
#include "sysid/recordings/recording.h"

namespace softgrip::tools {
namespace {

constexpr int settling_cycles = 1;
constexpr int measured_cycles = 3;
/// Key of the step that tracks the reference, which is its index in the sequence of tracking_yaml().
constexpr const char* track_step = "1";

std::string tracking_yaml(const ClosedLoopGain& gain, const std::string& channel) {
  const auto number = [](double value) { return shortest(value); };
  const double lowest_mm = gain.mean_mm - gain.amplitude_mm;
  return "name: closed_loop\nchannels: [" + channel +
         "]\nsteps:\n  - move: {displacement_mm: " + number(lowest_mm) +
         ", duration_s: 3, settle_s: 3}\n  - track: {mean_mm: " + number(gain.mean_mm) +
         ", amplitude_mm: " + number(gain.amplitude_mm) + ", frequency_hz: " + number(gain.frequency_hz) +
         ", cycles: " + std::to_string(settling_cycles + measured_cycles) +
         "}\n  - release: {duration_s: 2, purge_s: 1, timeout_s: 20, on_fail: vent}\n";
}

/// Returns the rig with the model and the gains of the scheme on its channel. If the rig cannot use them,
/// returns the reason.
tl::expected<ExperimentRig, NotPlayed> with_scheme(ExperimentRig rig, const model::Model& model,
                                                   const ClosedLoopScheme& scheme) {
  control::ChannelSettings& channel = rig.rig.settings.channels[rig.channel];
  channel.model = scheme.part ? scheme.part->model : model;
  channel.pid = scheme.pid;
  channel.feedforward.kind = scheme.feedforward;
  const auto accepted = control::check_feedforward(channel.model, channel.feedforward, channel.limits,
                                                   1 / rig.rig.settings.rate_hz);
  if (!accepted) return tl::unexpected(NotPlayed{false, accepted.error().text});
  return rig;
}

tl::expected<double, NotPlayed> rmse_of(const std::string& recording, const std::string& channel,
                                        double frequency_hz) {
  document::Problems problems;
  sysid::LogOptions options;
  options.channel = channel;
  const sysid::Campaign campaign = sysid::read_campaign({recording}, problems, options);
  if (campaign.logs.empty()) return tl::unexpected(NotPlayed{false, problems.format()});
  const sysid::Log& log = campaign.logs.front();
  const std::vector<double> reference = sysid::numbers_of(log, "reference_mm");
  const std::vector<std::string> steps = sysid::texts_of(log, "step");
  double began_s = std::nan(""), square = 0, count = 0;
  for (std::size_t i = 0; i < std::min(reference.size(), steps.size()); ++i) {
    if (steps[i] != track_step || !std::isfinite(reference[i])) continue;
    if (std::isnan(began_s)) began_s = log.time_s[i];
    const double cycles = (log.time_s[i] - began_s) * frequency_hz;
    if (cycles < settling_cycles || cycles > settling_cycles + measured_cycles ||
        !std::isfinite(log.displacement_mm[i]))
      continue;
    square += std::pow(log.displacement_mm[i] - reference[i], 2);
    ++count;
  }
  if (count == 0)
    return tl::unexpected(
        NotPlayed{false, "no reading was recorded while the reference was tracked: " + recording});
  return std::sqrt(square / count);
}

}  // namespace

tl::expected<RigTracking, NotPlayed> track_on_rig(const ExperimentRig& rig, const model::Model& recalibrated,
                                                  const model::Model& extended, const ClosedLoopGain& gain,
                                                  const std::string& folder, const Consent& consent) {
  if (!rig.simulated && !consent("channel '" + rig.channel_name() + "' of " + rig.rig.name + " will track " +
                                 gain.reference() + " twice")) {
    return tl::unexpected(NotPlayed{true, "softgrip was not allowed to move the rig"});
  }
  const auto rmse = [&](const char* name, const model::Model& model,
                        const ClosedLoopScheme& scheme) -> tl::expected<double, NotPlayed> {
    const auto changed = with_scheme(rig, model, scheme);
    if (!changed) return tl::unexpected(changed.error());
    const auto recording = run_on(*changed, name, tracking_yaml(gain, rig.channel_name()), folder);
    if (!recording) return tl::unexpected(recording.error());
    return rmse_of(*recording, rig.channel_name(), gain.frequency_hz);
  };
  RigTracking tracking;
  tracking.cycles = measured_cycles;
  const auto before = rmse("closed_loop_recalibrated", recalibrated, gain.recalibrated);
  if (!before) return tl::unexpected(before.error());
  const auto after = rmse("closed_loop_extended", extended, gain.extended);
  if (!after) return tl::unexpected(after.error());
  tracking.recalibrated_rmse_mm = *before;
  tracking.extended_rmse_mm = *after;
  return tracking;
}

result::Fields fields_of(const RigTracking& tracking) {
  return {{"recalibrated_rmse_mm", tracking.recalibrated_rmse_mm},
          {"extended_rmse_mm", tracking.extended_rmse_mm},
          {"cycles", tracking.cycles},
          {"of", "reading minus reference"}};
}

}  // namespace softgrip::tools
