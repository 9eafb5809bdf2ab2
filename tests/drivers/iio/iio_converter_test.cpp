// Tests one terminal of an industrial I/O board. Plain files with the paths of sysfs simulate the converter.

#include "drivers/iio/iio_converter.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/files.h"

namespace softgrip::drivers::iio_converter_test {
namespace {

class IioConverterTest : public testing::Test {
 protected:
  IioConverterTest() {
    std::filesystem::create_directory(root_.path() + "/iio:device0");
    put("name", "mcp4725");
    put("out_voltage0_raw", "0");
    put("out_voltage0_scale", "0.8");
  }
  void put(const std::string& file, const std::string& text) const {
    std::ofstream(root_.path() + "/iio:device0/" + file) << text << "\n";
  }
  std::string attach() {
    return converter_.attach(converters_in(root_.path()), root_.path(), {"mcp4725", "voltage0", 4095}, true);
  }

  const ScratchFolder root_;
  IioConverter converter_;
};

TEST_F(IioConverterTest, AttachingReadsTheScaling) {
  EXPECT_EQ(attach(), "");
  EXPECT_TRUE(converter_.raw.is_open());
  EXPECT_EQ(converter_.name, "mcp4725 voltage0");
  EXPECT_DOUBLE_EQ(converter_.scale, 0.0008) << "V per step";
}

TEST_F(IioConverterTest, AFailedAttemptClosesTheAttributeOfTheLastSession) {
  ASSERT_EQ(attach(), "");
  put("name", "dac7578");
  EXPECT_NE(attach().find("no converter of this computer is called `mcp4725`"), std::string::npos);
  EXPECT_FALSE(converter_.raw.is_open());
}

TEST_F(IioConverterTest, SwitchesTheOutputOn) {
  ASSERT_EQ(attach(), "");
  put("out_voltage0_powerdown", "1");
  EXPECT_EQ(converter_.look_at_powerdown("voltage0"), "");
  EXPECT_TRUE(converter_.is_off);
  EXPECT_EQ(converter_.switch_on(), 0);
  EXPECT_FALSE(converter_.is_off);
}

}  // namespace
}  // namespace softgrip::drivers::iio_converter_test
