#include "drivers/modbus/serial_port.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/files.h"

namespace softgrip::drivers::serial_port_test {
namespace {

namespace fs = std::filesystem;

const std::string by_id = "/dev/serial/by-id/usb-1a86_USB_Serial-if00-port0";

/// Tests with simulated folders /dev and /run. The folder /run contains the links that udev creates.
class SerialDevice : public testing::Test {
 protected:
  void plug(const std::string& node, const std::string& number, const std::string& port,
            const std::string& link) const {
    make_folder_of("/dev/" + node);
    std::ofstream(at("/dev/" + node)) << "";
    place_link("/dev/serial/by-path/" + port, "../../" + node);
    place_link(link, "../../" + node);
    std::string folder = link.substr(5);
    for (std::size_t slash = 0; (slash = folder.find('/')) != std::string::npos;)
      folder.replace(slash, 1, "\\x2f");
    place_link("/run/udev/links/" + folder + "/" + number, "0:/dev/" + node);
    std::ofstream(at("/run/udev/links/" + folder + "/.lock")) << "";
  }
  [[nodiscard]] std::optional<UnclearDevice> unclear(const std::string& path) const {
    return unclear_serial_device(path, root_);
  }
  [[nodiscard]] fs::path at(const std::string& path) const { return root_ / path.substr(1); }
  void make_folder_of(const std::string& path) const { fs::create_directories(at(path).parent_path()); }
  void place_link(const std::string& path, const std::string& target) const {
    make_folder_of(path);
    fs::remove(at(path));  // replace an existing link, as udev does when a second device claims the link
    fs::create_symlink(target, at(path));
  }

  const ScratchFolder scratch_;
  const fs::path root_ = scratch_.path();
};

TEST_F(SerialDevice, RefusesAnAmbiguousNameAndListsBothAdapters) {
  plug("ttyUSB0", "c188:0", "pci-0000:00:14.0-usb-0:1:1.0-port0", by_id);
  EXPECT_FALSE(unclear(by_id)) << "with one adapter the name is unambiguous";
  plug("ttyUSB1", "c188:1", "pci-0000:00:14.0-usb-0:2:1.0-port0", by_id);
  const auto refused = unclear(by_id);
  ASSERT_TRUE(refused);
  EXPECT_TRUE(refused->several);
  EXPECT_EQ(refused->message,
            "`" + by_id +
                "` fits 2 serial devices: /dev/ttyUSB0 (port "
                "`/dev/serial/by-path/pci-0000:00:14.0-usb-0:1:1.0-port0`) and /dev/ttyUSB1 (port "
                "`/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0`)");
  EXPECT_EQ(refused->hint,
            "write `/dev/serial/by-path/pci-0000:00:14.0-usb-0:1:1.0-port0` or "
            "`/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0`");
  EXPECT_FALSE(unclear("/dev/serial/by-path/pci-0000:00:14.0-usb-0:2:1.0-port0"));
  EXPECT_FALSE(unclear("/dev/ttyUSB1"));
  EXPECT_TRUE(unclear("/dev/serial/../serial/by-id/usb-1a86_USB_Serial-if00-port0"));
}

TEST_F(SerialDevice, IgnoresADisconnectedAdapter) {
  plug("ttyUSB0", "c188:0", "a", by_id);
  plug("ttyUSB1", "c188:1", "b", by_id);
  fs::remove(at("/dev/ttyUSB0"));
  EXPECT_FALSE(unclear(by_id));
}

TEST_F(SerialDevice, ReportsAMissingDeviceAndListsTheExistingOnes) {
  plug("ttyUSB0", "c188:0", "a", by_id);
  const auto absent = unclear("/dev/serial/by-id/usb-FTDI_other");
  ASSERT_TRUE(absent);
  EXPECT_FALSE(absent->several);
  EXPECT_EQ(absent->message,
            "no serial device of this computer is called `/dev/serial/by-id/usb-FTDI_other`");
  EXPECT_EQ(absent->hint, "there is " + by_id);
  fs::remove_all(at("/dev"));
  EXPECT_EQ(unclear(by_id)->hint, "no serial device is there");
}

TEST_F(SerialDevice, ChecksOnlyPathsInDev) {
  EXPECT_FALSE(unclear("/tmp/softgrip-line"));
}

}  // namespace
}  // namespace softgrip::drivers::serial_port_test
