// Tests the digital lines of a rig with simulated chips. The driver calls the API of the libgpiod version
// that is installed.

#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>

#include "base/files.h"
#include "drivers/gpio/gpio_lines.h"
#include "tests/drivers/gpio/fake_gpio.h"

namespace softgrip::drivers::gpio_libgpiod_test {
namespace {

using testing::FakeBias;
using testing::FakeChip;
using testing::FakeLine;

constexpr Nanoseconds no_wait = 0;

GpioLineSettings line(GpioRole role, std::uint32_t offset) {
  GpioLineSettings settings;
  settings.role = role;
  settings.chip = "gpiochip0";
  settings.offset = offset;
  return settings;
}

class Libgpiod : public ::testing::Test {
 protected:
  void SetUp() override {
    add_chip("gpiochip0", "first", 6);
    chips()[0].lines[2].name = "ESTOP";
  }
  void TearDown() override { chips().clear(); }

  static std::vector<FakeChip>& chips() { return testing::fake_chips(); }
  void add_chip(const std::string& name, const std::string& label, std::size_t lines) {
    chips().push_back({name, label, 0, true, std::vector<FakeLine>(lines)});
    std::ofstream(devices_ / name) << "";
  }
  auto open(const std::vector<GpioLineSettings>& lines) { return open_gpio_lines_in(devices_, sys_, lines); }
  GpioFailure failure(const std::vector<GpioLineSettings>& lines) {
    const auto opened = open(lines);
    EXPECT_FALSE(opened.has_value());
    return opened ? GpioFailure{} : opened.error();
  }

  const ScratchFolder scratch_;
  std::filesystem::path devices_ = scratch_.path();
  std::filesystem::path sys_;  // path of the simulated /sys; empty: the folder does not exist
};

TEST_F(Libgpiod, RequestsEachLineAsDescribed) {
  GpioLineSettings stop = line(GpioRole::emergency_stop, 1);
  stop.active_low = true;
  stop.bias = GpioBias::pull_up;
  GpioLineSettings enable = line(GpioRole::enable, 3);
  enable.active_low = true;
  const auto lines = open({stop, enable});
  ASSERT_TRUE(lines.has_value());
  const FakeLine& input = chips()[0].lines[1];
  EXPECT_TRUE(input.used && !input.output && input.edges_seen && input.active_low);
  EXPECT_EQ(input.bias, FakeBias::pull_up);
  EXPECT_EQ(input.consumer, "softgripd");
  const FakeLine& output = chips()[0].lines[3];
  EXPECT_TRUE(output.used && output.output && !output.edges_seen);
  EXPECT_TRUE(output.high) << "an output starts inactive, so the level of an active-low output is high";
  EXPECT_TRUE((*lines)->sees_edges());
}

TEST_F(Libgpiod, FindsAChipByLabelLinkAndAddress) {
  add_chip("gpiochip1", "second", 2);
  std::filesystem::create_symlink("gpiochip1", devices_ / "gpiochip4");
  const std::filesystem::path bus = devices_ / "bus/gpio/devices";
  std::filesystem::create_directories(bus);
  std::filesystem::create_directories(devices_ / "i2c-1/1-0020/gpiochip1");
  std::filesystem::create_directory_symlink(devices_ / "i2c-1/1-0020/gpiochip1", bus / "gpiochip1");
  const std::vector<ComputerDevice> found = chips_in(devices_, devices_);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(text_of(found[0]), "gpiochip0 (label `first`)");
  EXPECT_EQ(text_of(found[1]), "gpiochip1 (label `second`, address `1-0020`, link `gpiochip4`)");
  sys_ = devices_;
  for (const std::string& word : {std::string("second"), std::string("gpiochip4"), std::string("1-0020"),
                                  (bus / "gpiochip1").string()}) {
    GpioLineSettings lamp = line(GpioRole::ready_lamp, 1);
    lamp.chip = word;
    EXPECT_TRUE(open({lamp})) << word;
  }
}

TEST_F(Libgpiod, AppliesEveryBiasSetting) {
  const std::array<std::pair<GpioBias, FakeBias>, 4> all{{{GpioBias::as_is, FakeBias::as_is},
                                                          {GpioBias::disabled, FakeBias::disabled},
                                                          {GpioBias::pull_up, FakeBias::pull_up},
                                                          {GpioBias::pull_down, FakeBias::pull_down}}};
  for (const auto& [asked, had] : all) {
    GpioLineSettings settings = line(GpioRole::part_in_position, 0);
    settings.bias = asked;
    const auto lines = open({settings});
    ASSERT_TRUE(lines.has_value());
    EXPECT_EQ(chips()[0].lines[0].bias, had);
  }
}

TEST_F(Libgpiod, ReadsAndWritesLogicalLevels) {
  GpioLineSettings stop = line(GpioRole::emergency_stop, 0);
  stop.active_low = true;
  const auto lines = open({stop, line(GpioRole::ready_lamp, 4)});
  ASSERT_TRUE(lines.has_value());
  EXPECT_EQ((*lines)->read(GpioRole::emergency_stop), true);
  chips()[0].lines[0].high = true;
  EXPECT_EQ((*lines)->read(GpioRole::emergency_stop), false);
  EXPECT_TRUE((*lines)->write(GpioRole::ready_lamp, true));
  EXPECT_TRUE(chips()[0].lines[4].high);
  EXPECT_TRUE((*lines)->write(GpioRole::ready_lamp, false));
  EXPECT_FALSE(chips()[0].lines[4].high);
  EXPECT_TRUE((*lines)->write(GpioRole::fault_lamp, true)) << "a role without a line is accepted";
  EXPECT_EQ((*lines)->read(GpioRole::part_in_position), std::nullopt);
}

TEST_F(Libgpiod, ReturnsEdgesWithTimestamps) {
  const auto lines = open({line(GpioRole::emergency_stop, 0), line(GpioRole::part_in_position, 1)});
  ASSERT_TRUE(lines.has_value());
  std::array<GpioEdge, 8> edges;
  EXPECT_EQ((*lines)->wait(no_wait, edges), 0U);

  chips()[0].lines[1].change(true, 5'000'000'123);
  chips()[0].lines[1].change(false, 5'000'000'456);
  ASSERT_EQ((*lines)->wait(no_wait, edges), 2U);
  EXPECT_EQ(edges[0].role, GpioRole::part_in_position);
  EXPECT_TRUE(edges[0].active);
  EXPECT_EQ(edges[0].at, 5'000'000'123);
  EXPECT_FALSE(edges[1].active);
  EXPECT_EQ(edges[1].at, 5'000'000'456);
  EXPECT_EQ((*lines)->wait(no_wait, edges), 0U);
}

TEST_F(Libgpiod, ReturnsRemainingEdgesInTheNextCall) {
  const auto lines = open({line(GpioRole::emergency_stop, 0)});
  ASSERT_TRUE(lines.has_value());
  for (int i = 0; i < 5; ++i) chips()[0].lines[0].change(i % 2 == 0, i);
  std::array<GpioEdge, 3> edges;
  EXPECT_EQ((*lines)->wait(no_wait, edges), 3U);
  EXPECT_EQ(edges[2].at, 2);
  EXPECT_EQ((*lines)->wait(no_wait, edges), 2U);
  EXPECT_EQ(edges[1].at, 4);
}

TEST_F(Libgpiod, ReadsLevelsWhereAChipHasNoInterrupts) {
  chips()[0].interrupts = false;
  const auto lines = open({line(GpioRole::emergency_stop, 0)});
  ASSERT_TRUE(lines.has_value());
  EXPECT_FALSE((*lines)->sees_edges());
  chips()[0].lines[0].high = true;
  EXPECT_EQ((*lines)->read(GpioRole::emergency_stop), true);
}

TEST_F(Libgpiod, ReportsTheFailureOfAChip) {
  const auto lines = open({line(GpioRole::emergency_stop, 0), line(GpioRole::enable, 1)});
  ASSERT_TRUE(lines.has_value());
  chips()[0].lines[0].change(true, 1);
  for (FakeLine& one : chips()[0].lines) one.gone = true;
  std::array<GpioEdge, 4> edges;
  EXPECT_EQ((*lines)->wait(no_wait, edges), std::nullopt);
  EXPECT_EQ((*lines)->read(GpioRole::emergency_stop), std::nullopt);
  EXPECT_FALSE((*lines)->write(GpioRole::enable, true));
}

TEST_F(Libgpiod, FindsChipsByLabelAndLinesByName) {
  add_chip("gpiochip1", "second", 2);
  GpioLineSettings stop;
  stop.chip = "first";
  stop.line = "ESTOP";
  ASSERT_TRUE(open({stop}).has_value());
  stop.chip = "second";
  EXPECT_EQ(failure({stop}).message, "the chip `second` has no line named `ESTOP`");
  stop.chip = "third";
  const GpioFailure none = failure({stop});
  EXPECT_EQ(none.message, "no GPIO chip of this computer is called `third`");
  EXPECT_EQ(none.hint, "there are gpiochip0 (label `first`) and gpiochip1 (label `second`)");
}

TEST_F(Libgpiod, RefusesANameOfTwoChipsAndListsBothChips) {
  add_chip("gpiochip1", "first", 2);
  add_chip("gpiochip2", "gpiochip0", 2);
  GpioLineSettings stop = line(GpioRole::emergency_stop, 0);
  stop.chip = "first";
  const GpioFailure refused = failure({stop});
  EXPECT_EQ(refused.kind, GpioFailure::Kind::refused);
  EXPECT_EQ(refused.message,
            "`first` fits 2 GPIO chips: gpiochip0 (label `first`) and gpiochip1 (label `first`)");
  stop.chip = "gpiochip0";
  EXPECT_EQ(failure({stop}).message,
            "`gpiochip0` fits 2 GPIO chips: gpiochip0 (label `first`) and gpiochip2 (label `gpiochip0`)");
  for (const FakeChip& chip : chips()) EXPECT_FALSE(chip.lines[0].used) << chip.name;
}

TEST_F(Libgpiod, RefusesANameOfTwoLinesAndListsBothLines) {
  chips()[0].lines[5].name = "ESTOP";
  GpioLineSettings stop;
  stop.chip = "gpiochip0";
  stop.line = "ESTOP";
  const GpioFailure refused = failure({stop});
  EXPECT_EQ(refused.kind, GpioFailure::Kind::refused);
  EXPECT_EQ(refused.message, "the chip `gpiochip0` has 2 lines named `ESTOP`: 2 and 5");
  EXPECT_FALSE(chips()[0].lines[2].used || chips()[0].lines[5].used);
}

TEST_F(Libgpiod, RefusesALineNumberBeyondTheLastLine) {
  const GpioFailure beyond = failure({line(GpioRole::enable, 0), line(GpioRole::emergency_stop, 6)});
  EXPECT_EQ(beyond.kind, GpioFailure::Kind::refused);
  EXPECT_EQ(beyond.line, 1U);
  EXPECT_EQ(beyond.message, "the chip `gpiochip0` has no line 6");
  EXPECT_EQ(beyond.hint, "the lines of this chip have the numbers 0 to 5");
  EXPECT_FALSE(chips()[0].lines[0].used) << "after a failed request, all other lines are released";
}

TEST_F(Libgpiod, RefusesAnInputThatIsAnOutput) {
  chips()[0].lines[0].output = true;
  EXPECT_EQ(failure({line(GpioRole::emergency_stop, 0)}).message,
            "the line is configured as an output, but `emergency_stop` is an input");
}

TEST_F(Libgpiod, ErrorNamesTheConsumerOfABusyLine) {
  chips()[0].lines[0].used = true;
  chips()[0].lines[0].consumer = "button";
  const GpioFailure busy = failure({line(GpioRole::emergency_stop, 0)});
  EXPECT_EQ(busy.kind, GpioFailure::Kind::failed);
  EXPECT_EQ(busy.message, "the line is in use by `button`");
}

TEST_F(Libgpiod, ReportsMissingPermissionToOpenAChip) {
  chips()[0].open_error = EACCES;
  const GpioFailure denied = failure({line(GpioRole::emergency_stop, 0)});
  EXPECT_EQ(denied.kind, GpioFailure::Kind::failed);
  EXPECT_EQ(denied.message, "the chip `gpiochip0` cannot be opened: Permission denied");
  EXPECT_NE(denied.hint.find("udev"), std::string::npos);
}

TEST_F(Libgpiod, ReleasesAllLinesOnDestruction) {
  {
    const auto lines = open({line(GpioRole::emergency_stop, 0), line(GpioRole::enable, 1)});
    ASSERT_TRUE(lines.has_value());
  }
  for (const FakeLine& one : chips()[0].lines) EXPECT_FALSE(one.used);
}

}  // namespace
}  // namespace softgrip::drivers::gpio_libgpiod_test
