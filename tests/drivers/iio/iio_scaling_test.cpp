#include "drivers/iio/iio_scaling.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace softgrip::drivers::iio_scaling_test {
namespace {

namespace fs = std::filesystem;

class IioScalingTest : public testing::Test {
 protected:
  IioScalingTest() { fs::create_directories(folder_); }
  ~IioScalingTest() override { fs::remove_all(folder_); }
  void put(const std::string& file, const std::string& text) const {
    std::ofstream(folder_ / file) << text << "\n";
  }
  const fs::path folder_ = fs::temp_directory_path() / ("softgrip_iio_scaling_" + std::to_string(::getpid()));
};

TEST_F(IioScalingTest, IsThatOfTheChannelOrOfAllChannels) {
  put("in_voltage_scale", "2");
  put("in_voltage_offset", "-5");
  put("in_voltage1_scale", "4");
  const IioScaling shared = scaling_of(folder_, "voltage0", false);
  EXPECT_DOUBLE_EQ(shared.scale, 2e-3);
  EXPECT_EQ(shared.offset, -5);
  EXPECT_DOUBLE_EQ(scaling_of(folder_, "voltage1", false).scale, 4e-3);
  EXPECT_EQ(scaling_of(folder_, "voltage0", true).scale, 0) << "an output does not have the scale of inputs";
}

TEST_F(IioScalingTest, OfAProcessedNumberConvertsOnlyItsUnit) {
  EXPECT_DOUBLE_EQ(scaling_of_processed("voltage0").scale, 1e-3);
  EXPECT_EQ(scaling_of_processed("current0").scale, 1);
  EXPECT_EQ(scaling_of_processed("pressure").offset, 0);
}

}  // namespace
}  // namespace softgrip::drivers::iio_scaling_test
