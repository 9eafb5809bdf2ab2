#include "drivers/iio/iio_device.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/files.h"

namespace softgrip::drivers::iio_device_test {
namespace {

namespace fs = std::filesystem;

TEST(IioDevice, ReportsLabelNameSerialNumberAndAddress) {
  const ScratchFolder scratch;
  const fs::path root = fs::canonical(scratch.path());
  const fs::path hardware = root / "devices/i2c-1/1-0060";
  fs::create_directories(hardware / "iio:device3");
  fs::create_directory_symlink(hardware / "iio:device3", root / "iio:device3");
  fs::create_directories(root / "trigger0");
  std::ofstream(hardware / "iio:device3/label") << "left valve\n";
  std::ofstream(hardware / "iio:device3/name") << "mcp4725\n";
  std::ofstream(hardware / "iio:device3/serialnumber") << "4711\n";
  const std::vector<ComputerDevice> found = converters_in(root);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(text_of(found[0]),
            "iio:device3 (label `left valve`, name `mcp4725`, serial number `4711`, address `1-0060`)");
  EXPECT_EQ(identity_of(found[0]), "mcp4725 at " + hardware.string());
  EXPECT_TRUE(converters_in(root / "absent").empty());
}

TEST(IioDevice, IdentityIsTheNameIfTheDeviceIsOnNoBus) {
  const ScratchFolder scratch;
  fs::create_directories(fs::path(scratch.path()) / "iio:device0");
  std::ofstream(fs::path(scratch.path()) / "iio:device0/name") << "dac7578\n";
  EXPECT_EQ(identity_of(converters_in(scratch.path()).at(0)), "dac7578");
}

namespace fs = std::filesystem;

class IioScalingTest : public testing::Test {
 protected:
  void put(const std::string& file, const std::string& text) const {
    std::ofstream(folder_ / file) << text << "\n";
  }
  const ScratchFolder scratch_;
  const fs::path folder_ = scratch_.path();
};

TEST_F(IioScalingTest, UsesTheScaleOfTheChannelOrTheSharedScale) {
  put("in_voltage_scale", "2");
  put("in_voltage_offset", "-5");
  put("in_voltage1_scale", "4");
  const IioScaling shared = scaling_of(folder_, "voltage0", false);
  EXPECT_DOUBLE_EQ(shared.scale, 2e-3);
  EXPECT_EQ(shared.offset, -5);
  EXPECT_DOUBLE_EQ(scaling_of(folder_, "voltage1", false).scale, 4e-3);
  EXPECT_EQ(scaling_of(folder_, "voltage0", true).scale, 0) << "an output does not have the scale of inputs";
}

TEST_F(IioScalingTest, ConvertsOnlyTheUnitOfAProcessedValue) {
  EXPECT_DOUBLE_EQ(scaling_of_processed("voltage0").scale, 1e-3);
  EXPECT_EQ(scaling_of_processed("current0").scale, 1);
  EXPECT_EQ(scaling_of_processed("pressure").offset, 0);
}

}  // namespace
}  // namespace softgrip::drivers::iio_device_test
