// Runs a controller with the simulated board. `closed_loop MODEL.yaml` tracks a sine with feedforward and PID
// at 200 Hz. The simulated sensor has noise. The program prints the root mean square error of the last cycle
// of the sine.

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>

#include <softgrip/board.h>
#include <softgrip/control.h>

using namespace std::chrono_literals;

int main(int count, char** arguments) try {
  if (count != 2) {
    std::fprintf(stderr, "usage: closed_loop MODEL.yaml\n");
    return 2;
  }
  const softgrip::Model model = softgrip::Model::load(arguments[1]);
  constexpr auto tick = 5ms;

  softgrip::SimulatedFinger finger{.model = model};
  finger.noise = 0.03;
  softgrip::SimulatedBoard board({finger}, 0.005);

  softgrip::ControllerSettings settings{.model = model};
  settings.limits.pressure_max_kpa = 80;
  settings.pid.kp_kpa_per_mm = 2.7;
  settings.pid.ki_kpa_per_mm_s = 13;
  settings.extra_latency_s = 0.005;  // a command reaches the board one period (0.005 s) after its computation
  softgrip::Controller controller(settings);
  softgrip::Reference reference;
  reference.start(1, 0);         // the clock of the board starts at 1 s
  reference.ramp_to(6, 3);       // ramp of the reference to 6 mm within 3 s
  reference.sine(9, 3, 0.1, 3);  // three cycles of a sine with a period of 10 s
  controller.follow(reference);

  if (board.connect(100ms) != softgrip::BusStatus::ok) return 1;
  std::array<double, 1> command_kpa{0};
  std::array<softgrip::Reading, 1> reading;
  double squares = 0;
  int samples = 0;
  for (int i = 0; i < 200 * 33; ++i) {
    if (const auto status = board.exchange(command_kpa, reading, 2ms); status != softgrip::BusStatus::ok) {
      std::fprintf(stderr, "exchange: %s: %s\n", name_of(status).c_str(), board.detail().c_str());
      return 1;
    }
    const softgrip::ControlOutput output = controller.tick(board.now(), reading[0]);
    command_kpa[0] = output.command_kpa;
    if (i >= 200 * 23) {  // the last cycle of the sine
      const double error = board.displacement(0) - output.reference;
      squares += error * error;
      ++samples;
    }
    board.advance(tick);
  }
  std::printf("RMSE of the last cycle: %.3f %s\n", std::sqrt(squares / samples),
              name_of(model.unit()).c_str());
} catch (const std::exception& error) {
  std::fprintf(stderr, "closed_loop: %s\n", error.what());
  return 1;
}
