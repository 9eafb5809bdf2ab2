#include "base/computer_device.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/files.h"

namespace softgrip::computer_device_test {
namespace {

namespace fs = std::filesystem;

/// Simulates the folder tree /sys of a computer. Each device has its own folder below the folder of its bus.
/// A second folder contains one symbolic link to each device.
class ComputerDeviceTest : public testing::Test {
 protected:
  void add(const std::string& node, const std::string& place) {
    fs::create_directories(sys_ / "devices" / place / node);
    fs::create_directories(bus_);
    fs::create_directory_symlink(sys_ / "devices" / place / node, bus_ / node);
  }
  void write(const std::string& file, const std::string& text) {
    fs::create_directories((sys_ / file).parent_path());
    std::ofstream(sys_ / file) << text;
  }
  [[nodiscard]] std::vector<ComputerDevice> all() const { return devices_in(bus_, "iio:device"); }
  [[nodiscard]] std::string node_of(const std::string& word) const {
    const auto found = only_device(all(), word, "converter");
    return found ? found->node : found.error().message;
  }

  const ScratchFolder scratch_;
  const fs::path sys_ = fs::canonical(scratch_.path());
  const fs::path bus_ = sys_ / "bus/iio/devices";
};

TEST_F(ComputerDeviceTest, IsFoundByNodeAddressAndPath) {
  add("iio:device0", "platform/i2c-1/1-0060");
  add("iio:device1", "platform/i2c-1/1-0061");
  EXPECT_EQ(node_of("iio:device1"), "iio:device1");
  EXPECT_EQ(node_of("1-0060"), "iio:device0");
  EXPECT_EQ(node_of((sys_ / "devices/platform/i2c-1/1-0061").string()), "iio:device1");
  EXPECT_EQ(node_of((bus_ / "iio:device0").string()), "iio:device0");
  EXPECT_EQ(node_of("1-006"), "no converter of this computer is called `1-006`")
      << "a part of an address does not select a device";
  EXPECT_EQ(node_of(""), "no converter of this computer is called ``");
  EXPECT_EQ(node_of((sys_ / "devices/platform/i2c-1/1-00").string()).substr(0, 12), "no converter");
}

TEST_F(ComputerDeviceTest, AnAmbiguousNameIsRefusedWithBothDevices) {
  add("iio:device0", "platform/i2c-1/1-0060");
  add("iio:device1", "platform/i2c-1/1-0061");
  add("iio:device2", "platform/i2c-2/2-0048");
  std::vector<ComputerDevice> devices = all();
  for (std::size_t i = 0; i < 2; ++i) devices[i].add("name", "mcp4725");
  const auto found = only_device(devices, "mcp4725", "converter");
  ASSERT_FALSE(found);
  EXPECT_TRUE(found.error().several);
  EXPECT_EQ(found.error().message,
            "`mcp4725` fits 2 converters: iio:device0 (address `1-0060`, name `mcp4725`) and iio:device1 "
            "(address `1-0061`, name `mcp4725`)");
  EXPECT_EQ(found.error().hint, "write `1-0060` or `1-0061`");
  EXPECT_FALSE(only_device(devices, (sys_ / "devices/platform/i2c-1").string(), "converter"))
      << "a path that matches two devices is ambiguous";
}

TEST_F(ComputerDeviceTest, ALabelEqualToANodeNameIsAmbiguous) {
  add("iio:device0", "a/1-0060");
  add("iio:device1", "a/1-0061");
  std::vector<ComputerDevice> devices = all();
  devices[0].add("label", "iio:device1");
  EXPECT_FALSE(only_device(devices, "iio:device1", "converter"));
  EXPECT_TRUE(only_device(devices, "1-0061", "converter"));
}

TEST_F(ComputerDeviceTest, TheSerialNumberBelongsToTheUsbDeviceNotTheHub) {
  add("iio:device0", "usb1/1-1/1-1.2/1-1.2:1.0/i2c-7/7-0060");
  add("iio:device1", "usb1/1-1/1-1.3/1-1.3:1.0/i2c-8/8-0060");
  for (const char* usb : {"usb1", "usb1/1-1", "usb1/1-1/1-1.2", "usb1/1-1/1-1.3"})
    write(std::string("devices/") + usb + "/idVendor", "10c4\n");
  write("devices/usb1/serial", "0000:00:14.0\n");
  write("devices/usb1/1-1/1-1.2/serial", "DK0A1B2C\n");
  EXPECT_EQ(node_of("DK0A1B2C"), "iio:device0");
  EXPECT_EQ(node_of("0000:00:14.0"), "no converter of this computer is called `0000:00:14.0`");
}

TEST_F(ComputerDeviceTest, WithoutABusDevicesAreNamedByNodeOnly) {
  fs::create_directories(bus_ / "iio:device0");
  fs::create_directories(bus_ / "iio:device1");
  const std::vector<ComputerDevice> devices = all();
  ASSERT_EQ(devices.size(), 2U);
  EXPECT_EQ(text_of(devices[0]), "iio:device0");
  EXPECT_EQ(
      several_devices(devices, devices, "x", "converter").hint,
      "write `iio:device0` or `iio:device1`; the kernel may assign other device numbers after a reboot");
  EXPECT_EQ(only_device(devices, "x", "converter").error().hint, "there are iio:device0 and iio:device1");
  EXPECT_EQ(only_device({}, "x", "converter").error().hint, "no converter is there");
}

TEST(FirstLine, OmitsTrailingBlanksAndLaterLines) {
  const ScratchFolder scratch;
  const fs::path file = fs::path(scratch.path()) / "label";
  std::ofstream(file) << "left valve \r\nmore";
  EXPECT_EQ(first_line(file), "left valve");
  EXPECT_EQ(first_line(file / "absent"), "");
}

}  // namespace
}  // namespace softgrip::computer_device_test
