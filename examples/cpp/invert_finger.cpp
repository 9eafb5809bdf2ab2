// Inverts the model of a finger. `invert_finger MODEL.yaml` computes the pressure command for a sine of the
// displacement and simulates the finger with this command. The program prints the largest command, and the
// largest tracking error that occurs after 3 s.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <numbers>
#include <vector>

#include <softgrip/model.h>

int main(int count, char** arguments) try {
  if (count != 2) {
    std::fprintf(stderr, "usage: invert_finger MODEL.yaml\n");
    return 2;
  }
  const softgrip::Model model = softgrip::Model::load(arguments[1]);

  // Computes the reference: 20 s at 200 Hz of a sine between 4 and 8 mm with a period of 10 s. The finger
  // starts at rest and needs some time to reach the first value of the sine.
  std::vector<double> time_s, wanted;
  for (int i = 0; i <= 4000; ++i) {
    time_s.push_back(i / 200.0);
    wanted.push_back(6 - 2 * std::cos(2 * std::numbers::pi * 0.1 * time_s.back()));
  }
  softgrip::InverseOptions limits;
  limits.pressure_max_kpa = 80;
  const softgrip::Inverse inverse = model.inverse(time_s, wanted, limits);

  // The simulation holds each command until the next command, as a board does.
  softgrip::SimulateOptions held;
  held.held = true;
  const std::vector<double> moved = model.simulate(time_s, inverse.pressure_kpa, held);
  double worst = 0;
  for (std::size_t i = 600; i < moved.size(); ++i) worst = std::max(worst, std::abs(moved[i] - wanted[i]));
  std::printf("largest command %.2f kPa, largest error %.2g %s\n",
              *std::max_element(inverse.pressure_kpa.begin(), inverse.pressure_kpa.end()), worst,
              name_of(model.unit()).c_str());
} catch (const std::exception& error) {
  std::fprintf(stderr, "invert_finger: %s\n", error.what());
  return 1;
}
