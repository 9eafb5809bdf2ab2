#include "tools/commands/rig_to_move.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

#include "daemon/service/daemon.h"
#include "tools/client/daemon_client.h"
#include "tools/command_line/input_files.h"
#include "tools/command_line/terminal.h"

namespace softgrip::tools {

tl::expected<rig::RigFile, ExitCode> read_rig(const std::string& path) {
  return read_input(path, [](const std::string& file, document::Problems& problems) {
    auto rig = rig::load_rig(file, problems);
    if (rig) std::fputs(problems.format().c_str(), stderr);  // the rig is valid, so these are warnings
    return rig;
  });
}

ManualRig::ManualRig(const rig::RigFile& rig, daemon::BoardLock lock,
                     std::unique_ptr<drivers::GpioLines> lines)
    : lock_(std::move(lock)),
      board_(daemon::make_board(rig, clock_)),
      lines_(std::move(lines)),
      session_(
          rig, *board_, clock_, [this] { return stopped(); }, lines_.get()) {}

calibrate::Expected<std::unique_ptr<ManualRig>> ManualRig::open(const rig::RigFile& rig, bool move) {
  auto lock = daemon::BoardLock::take(rig);
  if (!lock) return tl::unexpected(calibrate::Refusal{ExitCode::state_refused, lock.error()});
  std::unique_ptr<drivers::GpioLines> lines;
  if (move && rig.gpio) {
    auto opened = drivers::open_gpio_lines(rig.gpio->lines);
    if (!opened) {
      return tl::unexpected(calibrate::Refusal{
          ExitCode::io, place_of(rig.gpio->places[opened.error().line]) + ": " + opened.error().message});
    }
    lines = std::move(*opened);
  }
  std::unique_ptr<ManualRig> manual(new ManualRig(rig, std::move(*lock), std::move(lines)));
  if (const auto connected = manual->session_.connect(); !connected)
    return tl::unexpected(calibrate::Refusal{ExitCode::io, connected.error().text});
  return manual;
}

void tell_silence(const std::string& why) {
  std::fprintf(stderr,
               "the board does not respond (%s), so the fingers may be under pressure: check the pressures "
               "before you reach into the gripper\n",
               why.c_str());
}

Consent consent_on_terminal(bool yes) {
  if (yes) return [](const std::string&) { return true; };
  return [](const std::string& what) { return confirmed(what + ". Ctrl-C vents the rig. Continue?"); };
}

tl::expected<ExperimentRig, ExitCode> rig_to_move(const std::string& path, const std::string& channel,
                                                  bool yes) {
  auto file = read_rig(path);
  if (!file) return tl::unexpected(file.error());
  auto rig = experiment_rig(std::move(*file), channel);
  if (!rig) return tl::unexpected(fail(ExitCode::usage, rig.error()));
  if (rig->simulated) return std::move(*rig);
  if (!yes && ::isatty(STDIN_FILENO) == 0) {
    return tl::unexpected(fail(ExitCode::usage,
                               "this command moves a rig, which cannot be confirmed without a terminal: "
                               "allow the motion with --yes"));
  }
  if (daemon_runs(rig->rig.socket.path))
    return tl::unexpected(fail(ExitCode::state_refused, stop_the_daemon));
  if (const auto lock = daemon::BoardLock::take(rig->rig); !lock)
    return tl::unexpected(fail(ExitCode::state_refused, lock.error()));
  return std::move(*rig);
}

}  // namespace softgrip::tools
