#include "daemon/service/named_device.h"
#include "base/files.h"

#include <gtest/gtest.h>

#include <fstream>

namespace softgrip::daemon::named_device_test {
namespace {

rig::RigFile with_line(const std::string& chip) {
  rig::RigFile rig;
  rig.gpio.emplace();
  drivers::GpioLineSettings line;
  line.chip = chip;
  line.offset = 0;
  rig.gpio->lines.push_back(line);
  return rig;
}

TEST(NamedDevice, FindsOnlyTheChipThatTheRigNames) {
  const rig::RigFile rig = with_line("gpiochip1");
  EXPECT_TRUE(named_device(rig, "gpiochip1"));
  EXPECT_FALSE(named_device(rig, "gpiochip0"));
  EXPECT_FALSE(named_device(rig, "gpiochip11"));
  EXPECT_FALSE(named_device(rig::RigFile{}, "gpiochip1")) << "a rig without digital lines uses no chip";
}

TEST(NamedDevice, FindsAConverterAndTheWrittenOutputAttributes) {
  const ScratchFolder root;
  for (const auto& [device, name] :
       {std::pair{"iio:device0", "ads1115"}, {"iio:device1", "dac7578"}, {"iio:device2", "other"}}) {
    std::filesystem::create_directory(root.path() + "/" + device);
    std::ofstream(root.path() + "/" + device + "/name") << name << "\n";
  }
  drivers::IioSettings converters;
  converters.root = root.path();
  converters.inputs = {{"iio:device0", "voltage0", 0}};
  converters.outputs = {{"dac7578", "voltage2", 4095}, {"dac7578", "voltage0", 4095}};
  rig::RigFile rig;
  rig.board = converters;
  std::ofstream(root.path() + "/iio:device1/out_voltage0_powerdown") << "1\n";
  const auto outputs = named_device(rig, "iio:device1");
  ASSERT_TRUE(outputs);
  EXPECT_EQ(outputs->written,
            (std::vector<std::string>{"out_voltage2_raw", "out_voltage0_raw", "out_voltage0_powerdown"}));
  const auto inputs = named_device(rig, "iio:device0");
  ASSERT_TRUE(inputs);
  EXPECT_TRUE(inputs->written.empty())
      << "the device has only inputs, so softgrip writes none of its attributes";
  EXPECT_FALSE(named_device(rig, "iio:device2"));
  EXPECT_FALSE(named_device(rig, "iio:device3"));
  std::ofstream(root.path() + "/iio:device2/name") << "dac7578\n";
  EXPECT_FALSE(named_device(rig, "iio:device1")) << "the name of two converters is ambiguous";
}

TEST(NamedDevice, RefusesOtherDevicesAndEmptyNames) {
  EXPECT_FALSE(named_device(with_line("mem"), "mem"));
  EXPECT_FALSE(named_device(with_line(""), ""));
}

}  // namespace
}  // namespace softgrip::daemon::named_device_test
