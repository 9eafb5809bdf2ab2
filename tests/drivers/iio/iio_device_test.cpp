#include "drivers/iio/iio_device.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace softgrip::drivers::iio_device_test {
namespace {

TEST(IioDevice, IsKnownByItsNameAndByItsFolder) {
  const std::filesystem::path root =
      std::filesystem::temp_directory_path() / ("softgrip-iio-device-" + std::to_string(::getpid()));
  const std::filesystem::path folder = root / "iio:device3";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "name") << "dac7578\n";
  EXPECT_EQ(name_of_converter(folder), "dac7578");
  EXPECT_TRUE(is_converter(folder, "dac7578"));
  EXPECT_TRUE(is_converter(folder, "iio:device3"));
  EXPECT_FALSE(is_converter(folder, "iio:device"));
  EXPECT_FALSE(is_converter(root / "iio:device4", "dac7578"));
  EXPECT_FALSE(is_converter(root / "iio:device4", "")) << "a converter that is not there has no name";
  std::filesystem::remove_all(root);
}

}  // namespace
}  // namespace softgrip::drivers::iio_device_test
