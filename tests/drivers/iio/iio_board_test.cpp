// Tests the board that consists of analog converters of the computer. Plain files with the paths of sysfs
// simulate the converters.

#include "drivers/iio/iio_board.h"
#include "base/files.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/support/allocation_counter.h"

namespace softgrip::drivers::iio_board_test {
namespace {

using namespace std::chrono_literals;
using model::Validity;
namespace fs = std::filesystem;

class IioBoardTest : public testing::Test {
 protected:
  IioBoardTest() {
    // Simulate two converters: an ADC that, like the ADS1115, has one scale per channel, and a DAC that has
    // an offset and one scale for all channels.
    put("iio:device0/name", "ads1115");
    for (const char* channel : {"voltage0", "voltage1"}) {
      put(std::string("iio:device0/in_") + channel + "_raw", "8000");
      put(std::string("iio:device0/in_") + channel + "_scale", "0.125");
    }
    put("iio:device1/name", "dac7578");
    put("iio:device1/out_voltage0_raw", "0");
    put("iio:device1/out_voltage1_raw", "0");
    put("iio:device1/out_voltage_scale", "0.8");
    put("iio:device1/out_voltage_offset", "0");
    settings_.root = root_.string();
    settings_.inputs = {{"ads1115", "voltage0", 0}, {"iio:device0", "voltage1", 0}};
    settings_.outputs = {{"dac7578", "voltage0", 4095}, {"dac7578", "voltage1", 4095}};
    for (std::size_t i = 0; i < 2; ++i) {
      ChannelWiring channel;
      channel.name = i == 0 ? "left" : "right";
      channel.valve = {.output = i, .unit = ElectricalUnit::volt, .scaling = {0, 0, 3.2, 100}};
      channel.displacement = {.input = i,
                              .unit = ElectricalUnit::volt,
                              .scaling = {0, -5, 4, 45},
                              .valid_min = 0.1,
                              .valid_max = 3.9,
                              .error_codes = {}};
      settings_.wiring.push_back(channel);
    }
  }

  void put(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    // Overwrite the file in place, because the board keeps the file open, as it keeps a file of sysfs open.
    std::ofstream(root_ / file) << text << "\n";
  }
  [[nodiscard]] std::string get(const std::string& file) const {
    std::string word;
    std::ifstream(root_ / file) >> word;
    return word;
  }
  BusStatus exchange(IioBoard& board, double left, double right) {
    return board.exchange(std::array{left, right}, readings_, 5s);
  }
  /// Returns the reason why no exchange with a new board succeeds.
  std::string refusal() {
    IioBoard board(settings_);
    static_cast<void>(board.connect(5s));
    EXPECT_EQ(exchange(board, 0, 0), BusStatus::disconnected);
    return board.detail();
  }

  const ScratchFolder scratch_;
  const fs::path root_ = scratch_.path();
  IioSettings settings_;
  std::vector<Reading> readings_{2};
};

TEST_F(IioBoardTest, WritesAndReadsRawValues) {
  const ModuleTerminals terminals = terminals_of(settings_);
  ASSERT_TRUE(wiring_problems({&terminals, 1}, settings_.wiring).empty());
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  put("iio:device0/in_voltage1_raw", "16000");
  ASSERT_EQ(exchange(board, 50, 25), BusStatus::ok) << board.detail();
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "2000") << "1.6 V are 2000 steps of 0.8 mV";
  EXPECT_EQ(get("iio:device1/out_voltage1_raw"), "1000");
  EXPECT_DOUBLE_EQ(readings_[0].displacement_mm, 7.5) << "the input is 1 V";
  EXPECT_DOUBLE_EQ(readings_[1].displacement_mm, 20) << "the input is 2 V";
  EXPECT_EQ(readings_[0].validity, Validity::valid);
  EXPECT_TRUE(std::isnan(readings_[0].pressure_kpa));
  EXPECT_EQ(readings_[1].sequence, 1U);
  EXPECT_GT(readings_[1].sampled_at, 0);
}

TEST_F(IioBoardTest, ReadsAConfiguredTemperatureInput) {
  put("iio:device0/in_voltage2_raw", "18400");
  put("iio:device0/in_voltage2_scale", "0.125");
  settings_.inputs.push_back({"ads1115", "voltage2", 0});
  settings_.wiring[1].temperature = InputWiring{.input = 2,
                                                .unit = ElectricalUnit::volt,
                                                .scaling = {0, 0, 10, 100},
                                                .valid_min = 0,
                                                .valid_max = 5,
                                                .error_codes = {}};
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  ASSERT_EQ(exchange(board, 0, 0), BusStatus::ok) << board.detail();
  EXPECT_TRUE(std::isnan(readings_[0].temperature_c));
  EXPECT_DOUBLE_EQ(readings_[1].temperature_c, 23);
  EXPECT_NE(board.budget().explanation.find("3 conversions"), std::string::npos)
      << board.budget().explanation;
}

TEST_F(IioBoardTest, AppliesTheOffsetBeforeTheScale) {
  put("iio:device1/out_voltage_offset", "-100");
  put("iio:device0/in_voltage0_offset", "800");
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  ASSERT_EQ(exchange(board, 50, 25), BusStatus::ok) << board.detail();
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "2100");
  EXPECT_DOUBLE_EQ(readings_[0].displacement_mm, -5 + 12.5 * 1.1);
}

TEST_F(IioBoardTest, ValidityFollowsFromTheRangeOfTheSensor) {
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok);
  put("iio:device0/in_voltage0_raw", "32767");
  ASSERT_EQ(exchange(board, 0, 0), BusStatus::ok);
  EXPECT_EQ(readings_[0].validity, Validity::out_of_range);
  EXPECT_EQ(readings_[1].validity, Validity::valid);
}

TEST_F(IioBoardTest, ACommandAboveTheRangeIsLimitedAndReported) {
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok);
  EXPECT_EQ(exchange(board, 110, 10), BusStatus::write_refused);
  EXPECT_NE(std::string(board.detail()).find("left"), std::string::npos) << board.detail();
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "4095");
  EXPECT_EQ(get("iio:device1/out_voltage1_raw"), "400");
  EXPECT_EQ(exchange(board, std::nan(""), 0), BusStatus::write_refused);
}

TEST_F(IioBoardTest, ErrorNamesAMissingDeviceChannelOrAttribute) {
  settings_.inputs[0].device = "ads1015";
  EXPECT_NE(refusal().find("there are "), std::string::npos);
  EXPECT_NE(refusal().find("ads1115"), std::string::npos) << refusal();
  settings_.inputs[0] = {"ads1115", "voltage7", 0};
  EXPECT_NE(refusal().find("in_voltage7_raw: No such file"), std::string::npos) << refusal();
  settings_.inputs[0] = {"ads1115", "voltage0", 0};
  fs::remove(root_ / "iio:device1/out_voltage_scale");
  EXPECT_NE(refusal().find("no valid attribute `scale`"), std::string::npos) << refusal();
  settings_.root = (root_ / "absent").string();
  EXPECT_NE(refusal().find("no converter is there"), std::string::npos) << refusal();
}

TEST_F(IioBoardTest, ANameOfTwoConvertersIsRefusedWithoutAWrite) {
  put("iio:device2/name", "dac7578");
  put("iio:device2/out_voltage0_raw", "17");
  put("iio:device2/out_voltage_scale", "0.8");
  EXPECT_NE(refusal().find("`dac7578` fits 2 converters: iio:device1 (name `dac7578`) and iio:device2 (name "
                           "`dac7578`)"),
            std::string::npos)
      << refusal();
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "0");
  EXPECT_EQ(get("iio:device2/out_voltage0_raw"), "17");
  put("iio:device2/label", "spare");
  put("iio:device1/label", "valves");
  for (IioTerminal& output : settings_.outputs) output.device = "valves";
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  ASSERT_EQ(exchange(board, 50, 25), BusStatus::ok) << board.detail();
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "2000");
  EXPECT_EQ(get("iio:device2/out_voltage0_raw"), "17");
}

TEST_F(IioBoardTest, AnOutputThatIsSwitchedOffIsEnabledAfterTheFirstWrite) {
  put("iio:device1/out_voltage0_powerdown", "1");
  put("iio:device1/out_voltage1_powerdown", "0");
  put("iio:device1/out_voltage0_raw", "1234");
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  EXPECT_EQ(get("iio:device1/out_voltage0_powerdown"), "1")
      << "the output must stay off while its register still has the old value";
  EXPECT_EQ(exchange(board, 110, 10), BusStatus::write_refused);
  EXPECT_EQ(get("iio:device1/out_voltage0_powerdown"), "1");
  BusStatus status = BusStatus::disconnected;
  EXPECT_EQ(softgrip::test::allocations_of([&] { status = exchange(board, 50, 25); }), 0U);
  EXPECT_EQ(status, BusStatus::ok) << board.detail();
  EXPECT_EQ(get("iio:device1/out_voltage0_powerdown"), "0");
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "2000");
}

TEST_F(IioBoardTest, ClearsASharedPowerdownAttribute) {
  put("iio:device1/out_voltage_powerdown", "1");
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  ASSERT_EQ(exchange(board, 50, 25), BusStatus::ok) << board.detail();
  EXPECT_EQ(get("iio:device1/out_voltage_powerdown"), "0");
}

TEST_F(IioBoardTest, APowerdownThatIsInaccessibleIsRefused) {
  put("iio:device1/out_voltage1_powerdown", "off");
  EXPECT_NE(refusal().find("out_voltage1_powerdown: no number"), std::string::npos) << refusal();
  const fs::path powerdown = root_ / "iio:device1/out_voltage1_powerdown";
  fs::remove(powerdown);
  fs::create_symlink("/proc/sys/kernel/ngroups_max", powerdown);  // link to a file with a value above 0 that
                                                                  // cannot be changed
  EXPECT_NE(refusal().find("out_voltage1_powerdown is 1 and cannot be cleared: Permission denied"),
            std::string::npos)
      << refusal();
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "0");
}

TEST_F(IioBoardTest, APowerdownThatPersistsEndsThisSessionAndTheNext) {
  const fs::path powerdown = root_ / "iio:device1/out_voltage1_powerdown";
  // The kernel accepts a write of any number to the file urandom_min_reseed_secs. However, the file then
  // still contains a value above 0.
  const std::string keeps_its_number = "/proc/sys/kernel/random/urandom_min_reseed_secs";
  if (::access(keeps_its_number.c_str(), W_OK) != 0) GTEST_SKIP() << "needs root: " << keeps_its_number;
  fs::create_symlink(keeps_its_number, powerdown);
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  EXPECT_EQ(exchange(board, 0, 0), BusStatus::disconnected);
  EXPECT_NE(std::string(board.detail()).find("out_voltage1_powerdown: this attribute is still 1"),
            std::string::npos)
      << board.detail();
  EXPECT_EQ(readings_[0].sequence, 0U);
  EXPECT_EQ(board.connect(5s), BusStatus::ok);
  put("iio:device1/out_voltage0_raw", "1234");
  EXPECT_EQ(exchange(board, 0, 0), BusStatus::disconnected);
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "0") << "the other output must vent";
  EXPECT_NE(std::string(board.detail()).find("is still 1 after 0 was written"), std::string::npos)
      << board.detail();
  fs::remove(powerdown);
  put("iio:device1/out_voltage1_powerdown", "0");
  EXPECT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  EXPECT_EQ(exchange(board, 50, 25), BusStatus::ok) << board.detail();
}

TEST_F(IioBoardTest, AnOutputWithoutAChannelStaysSwitchedOff) {
  settings_.outputs.push_back({"dac7578", "voltage2", 4095});
  put("iio:device1/out_voltage2_raw", "17");
  put("iio:device1/out_voltage2_powerdown", "1");
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  EXPECT_EQ(exchange(board, 50, 25), BusStatus::ok) << board.detail();
  EXPECT_EQ(get("iio:device1/out_voltage2_powerdown"), "1");
  EXPECT_EQ(get("iio:device1/out_voltage2_raw"), "17");
}

TEST_F(IioBoardTest, APressureIsReadInKilopascals) {
  put("iio:device2/name", "bmp280");
  put("iio:device2/in_pressure_input", "121.3");  // an input in physical units without channel number and
                                                  // scale
  put("iio:device3/name", "mpl115");
  put("iio:device3/in_pressure0_raw", "400");
  put("iio:device3/in_pressure_scale", "0.25");
  put("iio:device3/in_pressure_offset", "80");
  settings_.inputs.push_back({"bmp280", "pressure", 0});
  settings_.inputs.push_back({"mpl115", "pressure0", 0});
  const TwoPoints above_ambient{101.3, 0, 201.3, 100};
  for (std::size_t i = 0; i < 2; ++i) {
    settings_.wiring[i].pressure = InputWiring{.input = 2 + i,
                                               .unit = ElectricalUnit::kilopascal,
                                               .scaling = above_ambient,
                                               .valid_min = 90,
                                               .valid_max = 250,
                                               .error_codes = {}};
  }
  const ModuleTerminals terminals = terminals_of(settings_);
  EXPECT_TRUE(wiring_problems({&terminals, 1}, settings_.wiring).empty());
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  ASSERT_EQ(exchange(board, 50, 25), BusStatus::ok) << board.detail();
  EXPECT_NEAR(readings_[0].pressure_kpa, 20, 1e-9);
  EXPECT_NEAR(readings_[1].pressure_kpa, 18.7, 1e-9)
      << "the absolute pressure is (400 + 80) * 0.25 kPa = 120 kPa";
}

TEST_F(IioBoardTest, AHeartbeatChangesWithEveryExchange) {
  put("iio:device1/out_voltage2_raw", "0");
  put("iio:device1/out_voltage2_powerdown", "1");
  settings_.heartbeat = IioHeartbeat{{"dac7578", "voltage2", 0}, 0, 4095, 0.5};
  IioBoard board(settings_);
  EXPECT_TRUE(board.has_watchdog());
  EXPECT_EQ(board.watchdog_time(), 500ms);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  EXPECT_EQ(get("iio:device1/out_voltage2_raw"), "0") << "connecting writes nothing";
  BusStatus status = BusStatus::disconnected;
  for (const char* const raw : {"4095", "0", "4095", "0"}) {
    EXPECT_EQ(softgrip::test::allocations_of([&] { status = exchange(board, 50, 25); }), 0U);
    EXPECT_EQ(status, BusStatus::ok) << board.detail();
    EXPECT_EQ(get("iio:device1/out_voltage2_raw"), raw);
  }
  EXPECT_EQ(get("iio:device1/out_voltage2_powerdown"), "0");
  put("iio:device0/in_voltage0_raw", "no");
  EXPECT_EQ(exchange(board, 50, 25), BusStatus::disconnected);
  const std::string last = get("iio:device1/out_voltage2_raw");
  EXPECT_EQ(exchange(board, 50, 25), BusStatus::disconnected);
  EXPECT_EQ(get("iio:device1/out_voltage2_raw"), last) << "the heartbeat does not change without a session";
  settings_.heartbeat->terminal = settings_.outputs[0];
  EXPECT_NE(refusal().find("both are "), std::string::npos) << "an output of a valve cannot be a heartbeat";
}

TEST_F(IioBoardTest, RefusesOneConverterChannelWithTwoNames) {
  settings_.outputs[1] = {"iio:device1", "voltage0", 4095};
  EXPECT_NE(refusal().find("dac7578 voltage0 and iio:device1 voltage0: both are "), std::string::npos)
      << refusal();
  settings_.outputs[1] = {"dac7578", "voltage1", 4095};
  settings_.inputs[1] = {"iio:device0", "voltage0", 0};
  EXPECT_NE(refusal().find("both are "), std::string::npos) << refusal();
}

/// Tests boards with a missing converter. The outputs of the other converters must follow the commands, so
/// that they vent.
class IioMissingTest : public IioBoardTest {
 protected:
  IioMissingTest() {
    put("iio:device2/name", "mcp4725");
    put("iio:device2/out_voltage0_raw", "0");
    put("iio:device2/out_voltage0_scale", "0.8");
    put("iio:device1/out_voltage2_raw", "0");
    settings_.outputs[1] = {"mcp4725", "voltage0", 4095};
    settings_.heartbeat = IioHeartbeat{{"dac7578", "voltage2", 0}, 0, 4095, 0.5};
  }
  /// Pressurises both fingers, and removes a converter.
  void lose(IioBoard& board, const std::string& node) {
    ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
    ASSERT_EQ(exchange(board, 50, 25), BusStatus::ok) << board.detail();
    fs::remove_all(root_ / node);
  }
  /// Writes the rest pressures in a new session. Neither the session nor the heartbeat may succeed.
  std::string vent(IioBoard& board) {
    const std::string heartbeat = get("iio:device1/out_voltage2_raw");
    EXPECT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
    EXPECT_EQ(exchange(board, 0, 0), BusStatus::disconnected);
    EXPECT_EQ(get("iio:device1/out_voltage2_raw"), heartbeat);
    return board.detail();
  }
};

TEST_F(IioMissingTest, TheOutputsVentWithoutAnInput) {
  IioBoard board(settings_);
  lose(board, "iio:device0");
  EXPECT_NE(vent(board).find("no converter of this computer is called `ads1115`"), std::string::npos);
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "0");
  EXPECT_EQ(get("iio:device2/out_voltage0_raw"), "0");
}

TEST_F(IioMissingTest, ANewProcessVentsTheOutputsWithoutAnInput) {
  put("iio:device1/out_voltage0_raw", "2000");
  fs::remove_all(root_ / "iio:device0");
  IioBoard board(settings_);
  EXPECT_NE(vent(board).find("`ads1115`"), std::string::npos);
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "0");
}

TEST_F(IioMissingTest, AnInputThatCannotBeReadDoesNotPreventTheVent) {
  put("iio:device1/out_voltage0_raw", "2000");
  put("iio:device0/in_voltage1_raw", "no");
  IioBoard board(settings_);
  EXPECT_NE(vent(board).find("voltage1: no number"), std::string::npos);
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "0");
}

TEST_F(IioMissingTest, TheFirstOutputVentsWithoutTheSecond) {
  IioBoard board(settings_);
  lose(board, "iio:device2");
  EXPECT_NE(vent(board).find("no converter of this computer is called `mcp4725`"), std::string::npos);
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "0");
}

TEST_F(IioMissingTest, TheSecondOutputVentsWithoutTheFirst) {
  IioBoard board(settings_);
  lose(board, "iio:device1");
  EXPECT_NE(vent(board).find("no converter of this computer is called `dac7578`"), std::string::npos);
  EXPECT_EQ(get("iio:device2/out_voltage0_raw"), "0");
}

/// A write to /dev/full fails with ENOSPC.
TEST_F(IioMissingTest, TheOtherOutputIsWrittenAfterAFailedWrite) {
  fs::remove(root_ / "iio:device1/out_voltage0_raw");
  fs::create_symlink("/dev/full", root_ / "iio:device1/out_voltage0_raw");
  put("iio:device2/out_voltage0_raw", "2000");
  IioBoard board(settings_);
  EXPECT_NE(vent(board).find("dac7578 voltage0: No space left on device"), std::string::npos);
  EXPECT_EQ(get("iio:device2/out_voltage0_raw"), "0");
}

TEST_F(IioMissingTest, NoOutputMeansNoSession) {
  fs::remove_all(root_ / "iio:device1");
  fs::remove_all(root_ / "iio:device2");
  IioBoard board(settings_);
  EXPECT_EQ(board.connect(5s), BusStatus::disconnected);
  EXPECT_NE(std::string(board.detail()).find("`dac7578`"), std::string::npos) << board.detail();
}

/// Tests converters on a bus. A converter disappears and returns, and the kernel then gives it another device
/// number.
class IioBusTest : public IioBoardTest {
 protected:
  IioBusTest() {
    fs::remove_all(root_ / "iio:device1");
    plug(1, "1-0060");
  }
  void plug(int number, const std::string& address) const {
    const std::string node = "iio:device" + std::to_string(number);
    const std::string folder = "hardware/" + address + "/" + node;
    put(folder + "/name", "dac7578");
    put(folder + "/out_voltage0_raw", "0");
    put(folder + "/out_voltage1_raw", "0");
    put(folder + "/out_voltage_scale", "0.8");
    fs::create_directory_symlink(root_ / folder, root_ / node);
  }
  void unplug(int number, const std::string& address) const {
    const std::string node = "iio:device" + std::to_string(number);
    fs::remove(root_ / node);
    fs::remove_all(root_ / "hardware" / address);
  }
  /// Ends the session of the board, as if the converter had disappeared.
  void lose(IioBoard& board) {
    put("iio:device0/in_voltage0_raw", "no");
    EXPECT_EQ(exchange(board, 10, 10), BusStatus::disconnected);
    put("iio:device0/in_voltage0_raw", "8000");
  }
};

TEST_F(IioBusTest, AConverterIsFoundAgainUnderAnotherNumber) {
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  lose(board);
  unplug(1, "1-0060");
  EXPECT_EQ(board.connect(5s), BusStatus::disconnected);
  EXPECT_NE(std::string(board.detail()).find("no converter of this computer is called `dac7578`"),
            std::string::npos)
      << board.detail();
  EXPECT_NE(std::string(board.detail()).find("ads1115"), std::string::npos) << board.detail();
  plug(4, "1-0060");
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  ASSERT_EQ(exchange(board, 50, 25), BusStatus::ok);
  EXPECT_EQ(get("iio:device4/out_voltage0_raw"), "2000");
}

TEST_F(IioBusTest, RefusesADifferentConverterWithTheSameName) {
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  lose(board);
  unplug(1, "1-0060");
  plug(1, "1-0061");
  EXPECT_EQ(board.connect(5s), BusStatus::disconnected);
  EXPECT_NE(std::string(board.detail()).find("1-0061: restart softgripd if this change is intended"),
            std::string::npos)
      << board.detail();
  EXPECT_EQ(exchange(board, 50, 25), BusStatus::disconnected);
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "0");
  IioBoard after_a_start(settings_);
  EXPECT_EQ(after_a_start.connect(5s), BusStatus::ok) << after_a_start.detail();
}

TEST_F(IioBusTest, FindsALabelledConverterAtAnotherAddress) {
  put("iio:device1/label", "valves");
  for (IioTerminal& output : settings_.outputs) output.device = "valves";
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  lose(board);
  unplug(1, "1-0060");
  plug(1, "2-0060");
  put("iio:device1/label", "valves");
  EXPECT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
}

TEST_F(IioBoardTest, ANonNumericReadingEndsTheSession) {
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok);
  put("iio:device0/in_voltage0_raw", "no");
  EXPECT_EQ(exchange(board, 10, 10), BusStatus::disconnected);
  EXPECT_EQ(readings_[0].sequence, 0U) << "if one reading fails, no reading changes";
  EXPECT_EQ(exchange(board, 10, 10), BusStatus::disconnected);
  put("iio:device0/in_voltage0_raw", "8000");
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  EXPECT_EQ(exchange(board, 10, 10), BusStatus::ok);
}

TEST_F(IioBoardTest, ConnectingWritesNothing) {
  put("iio:device1/out_voltage0_raw", "1234");
  IioBoard board(settings_);
  EXPECT_NE(board.budget().explanation.find("not measured"), std::string::npos);
  ASSERT_EQ(board.connect(5s), BusStatus::ok);
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "1234");
  EXPECT_NE(board.budget().explanation.find("2 writes and 2 conversions"), std::string::npos)
      << board.budget().explanation;
  EXPECT_FALSE(board.has_watchdog());
  EXPECT_EQ(board.describe(), "industrial I/O: dac7578 ads1115 iio:device0");
}

TEST_F(IioBoardTest, AnExchangeAllocatesNothing) {
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok);
  BusStatus status = BusStatus::disconnected;
  const std::size_t made = softgrip::test::allocations_of([&] { status = exchange(board, 10, 20); });
  EXPECT_EQ(status, BusStatus::ok);
  EXPECT_EQ(made, 0U);
  put("iio:device0/in_voltage0_raw", "no");
  EXPECT_EQ(softgrip::test::allocations_of([&] { status = exchange(board, 10, 200); }), 0U);
}

}  // namespace
}  // namespace softgrip::drivers::iio_board_test
