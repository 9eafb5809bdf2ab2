#include "tools/commands/rig_to_move.h"

#include <utility>
#include <vector>

#include "base/numbers.h"
#include "tools/client/daemon_client.h"

namespace softgrip::tools {
namespace {

tl::unexpected<NotPlayed> failed(std::string why) {
  return tl::unexpected(NotPlayed{false, std::move(why)});
}

std::string what_is_done(const ExperimentRig& rig, std::size_t readings) {
  return "The sensor of channel '" + rig.channel_name() + "' of " + rig.rig.name +
         " is checked against a gauge: you hold the target of the sensor at " + std::to_string(readings) +
         " positions, " + significant(sysid::minutes_for(readings), 2) +
         " minutes. All fingers of the rig are vented, so a held part drops. No finger moves";
}

}  // namespace

GaugeTaker gauge_by_hand(ExperimentRig rig, Consent consent) {
  return [rig = std::move(rig), consent = std::move(consent)](
             const std::vector<double>& positions_mm,
             const std::string& folder) -> tl::expected<sysid::GaugeFile, NotPlayed> {
    if (!consent(what_is_done(rig, positions_mm.size())))
      return tl::unexpected(NotPlayed{true, "softgrip was not allowed to check the sensor"});
    if (daemon_runs(rig.rig.socket.path)) return failed(stop_the_daemon);
    const auto manual = ManualRig::open(rig.rig, false);
    if (!manual) return failed(manual.error().text);
    MotionSession& session = (*manual)->session();
    calibrate::TerminalOperator terminal;
    terminal.tell(
        "Enter: the target is at this position; a number: actual position of the target [mm]; -: skip this "
        "position");
    calibrate::Settings settings;
    settings.channel = rig.channel;
    const auto visits = calibrate::read_positions(session, terminal, settings, positions_mm);
    const bool safe = session.leave(tell_silence);
    if (!visits)
      return tl::unexpected(
          NotPlayed{visits.error().code == ExitCode::failed, visits.error().text, visits.error().code});
    if (!safe)
      return failed(
          "the board did not confirm the rest pressures: check the pressures before you reach into the "
          "gripper");
    std::vector<sysid::GaugeReading> readings;
    for (const calibrate::GaugeVisit& visit : *visits)
      readings.push_back({visit.position_mm, visit.reading_mm, static_cast<double>(visit.count)});
    return gauge_file_of(readings, folder);
  };
}

}  // namespace softgrip::tools
