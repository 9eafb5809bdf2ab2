#include "drivers/iio/iio_device.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/files.h"

namespace softgrip::drivers::iio_device_test {
namespace {

namespace fs = std::filesystem;

TEST(IioDevice, IsKnownByItsLabelItsNameItsSerialNumberAndItsAddress) {
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

TEST(IioDevice, IsItsNameWhereItIsOnNoBus) {
  const ScratchFolder scratch;
  fs::create_directories(fs::path(scratch.path()) / "iio:device0");
  std::ofstream(fs::path(scratch.path()) / "iio:device0/name") << "dac7578\n";
  EXPECT_EQ(identity_of(converters_in(scratch.path()).at(0)), "dac7578");
}

}  // namespace
}  // namespace softgrip::drivers::iio_device_test
