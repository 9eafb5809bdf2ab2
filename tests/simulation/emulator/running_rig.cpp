#include "tests/simulation/emulator/running_rig.h"

#include <sys/signalfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <stdexcept>

#include "base/net/listener.h"
#include "model/file/model_file.h"
#include "simulation/emulator/finger.h"

namespace softgrip::simulation::test {
namespace {

std::vector<simulation::PlantSettings> plants(std::size_t channels) {
  document::Problems problems;
  std::vector<simulation::PlantSettings> result(channels);
  for (auto& plant : result) {
    plant.model = *model::load_model(SOFTGRIP_SOURCE_DIR "/config/models/bench_twin.yaml", problems);
  }
  return result;
}

std::string new_line_name() {
  static int count = 0;
  return (std::filesystem::temp_directory_path() /
          ("softgrip_line_" + std::to_string(::getpid()) + "_" + std::to_string(count++)))
      .string();
}

}  // namespace

RunningRig::RunningRig(const RunningRigSettings& settings) {
  std::signal(SIGPIPE, SIG_IGN);
  ServerSockets sockets;
  EmulatorSettings emulated;
  emulated.wire = settings.wire;
  emulated.wiring = *default_wiring(settings.maps, settings.channels);
  emulated.plants = plants(settings.channels);
  emulated.faults = settings.habits;
  if (settings.rtu_over_tcp) emulated.wire = Wire::rtu;
  if (settings.wire == Wire::rtu) {
    drivers::SerialLine line = settings.line;
    line.device = new_line_name();
    auto end = SerialEnd::open(line);
    if (!end) throw std::runtime_error(end.error());
    sockets.line = line;
    sockets.end = std::move(*end);
    board_.links.emplace_back(line);
  }
  for (std::size_t i = 0; i < settings.maps.size(); ++i) {
    const bool serial = settings.wire == Wire::rtu;
    const auto unit = static_cast<std::uint8_t>(serial ? 1 + i : 1);
    const std::size_t link = serial ? 0 : i;
    emulated.modules.push_back({settings.maps[i], unit, link});
    board_.modules.push_back({settings.names[i], settings.maps[i], unit, link});
    if (serial) continue;
    auto listener = net::listen_tcp("127.0.0.1", 0);
    if (!listener) throw std::runtime_error(listener.error());
    board_.links.emplace_back(drivers::TcpAddress{"127.0.0.1", listener->port});
    sockets.modbus.push_back(std::move(listener->socket));
  }
  board_.wiring = emulated.wiring;

  std::array<int, 2> pipe{};
  if (::pipe(pipe.data()) != 0) throw std::runtime_error("pipe");
  sockets.signals = Descriptor{pipe[0]};
  stop_ = Descriptor{pipe[1]};
  emulator_ = std::make_unique<Emulator>(std::move(emulated));
  for (const FaultSpec& habit : settings.habits) emulator_->trigger(habit.name, 0);
  thread_ = std::thread(
      [this, sockets = std::move(sockets)]() mutable { Server(*emulator_, std::move(sockets)).run([] {}); });
}

RunningRig::~RunningRig() {
  (void)stop();
}

const Emulator& RunningRig::stop() {
  if (thread_.joinable()) {
    signalfd_siginfo end{};
    end.ssi_signo = SIGTERM;
    if (::write(stop_.get(), &end, sizeof end) < 0) std::abort();
    thread_.join();
  }
  return *emulator_;
}

}  // namespace softgrip::simulation::test
