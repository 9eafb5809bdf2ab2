// Compares the chain with results that SciPy computed from the continuous equations. golden/make_golden.py
// contains its own copy of signals and parameters. Therefore this test also detects an error in the preset
// models or the signals of the project.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>

#include "model/chain.h"
#include "model/signals.h"
#include "tests/model/presets.h"

namespace softgrip::model::testing::chain_golden_test {
namespace {

TEST(ChainGolden, PresetsAgreeWithTheSciPySolution) {
  std::ifstream file(SOFTGRIP_SOURCE_DIR "/tests/model/golden/chain_golden.csv");
  std::string line;
  ASSERT_TRUE(std::getline(file, line));
  EXPECT_EQ(line, "model,signal,time_s,displacement_mm");
  constexpr double dt = 5e-3;
  std::string running;
  Chain<double> chain(preset("zhang2025"));
  SignalName signal = SignalName::tp1;
  int done = 0;
  int rows = 0;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::string model, name, time, displacement;
    std::getline(cells, model, ',');
    std::getline(cells, name, ',');
    std::getline(cells, time, ',');
    std::getline(cells, displacement, ',');
    if (running != model + name) {
      running = model + name;
      chain = Chain<double>(preset(model), {}, dt);
      signal = signal_names.find(name).value();
      done = 0;
    }
    while (done < std::lround(std::stod(time) / dt)) {
      ++done;
      chain.step(dt, value_kpa(signal, done * dt));
    }
    ASSERT_NEAR(chain.reading_mm(), std::stod(displacement), 1e-7) << line;
    ++rows;
  }
  EXPECT_EQ(rows, 326);
}

}  // namespace
}  // namespace softgrip::model::testing::chain_golden_test
