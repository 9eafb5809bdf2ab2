// Converters of this computer, played by plain files in the places where sysfs has them.

#include "drivers/iio/iio_board.h"

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
    fs::create_directories(root_);
    // An ADS1115-like converter with a scale per channel, a DAC with one scale for all and an offset.
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
  ~IioBoardTest() override { fs::remove_all(root_); }

  void put(const std::string& file, const std::string& text) const {
    fs::create_directories((root_ / file).parent_path());
    // In place: the board has the file open, as it has the attribute.
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
  std::string refusal() {
    IioBoard board(settings_);
    EXPECT_EQ(board.connect(5s), BusStatus::disconnected);
    EXPECT_EQ(exchange(board, 0, 0), BusStatus::disconnected);
    return board.detail();
  }

  const fs::path root_ = fs::temp_directory_path() / ("softgrip_iio_" + std::to_string(::getpid()));
  IioSettings settings_;
  std::vector<Reading> readings_{2};
};

TEST_F(IioBoardTest, WritesRawNumbersAndReadsThem) {
  const ModuleTerminals terminals = terminals_of(settings_);
  ASSERT_TRUE(wiring_problems({&terminals, 1}, settings_.wiring).empty());
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  put("iio:device0/in_voltage1_raw", "16000");
  ASSERT_EQ(exchange(board, 50, 25), BusStatus::ok) << board.detail();
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "2000") << "1.6 V of 0.8 mV steps";
  EXPECT_EQ(get("iio:device1/out_voltage1_raw"), "1000");
  EXPECT_DOUBLE_EQ(readings_[0].displacement_mm, 7.5) << "1 V";
  EXPECT_DOUBLE_EQ(readings_[1].displacement_mm, 20) << "2 V";
  EXPECT_EQ(readings_[0].validity, Validity::valid);
  EXPECT_TRUE(std::isnan(readings_[0].pressure_kpa));
  EXPECT_EQ(readings_[1].sequence, 1U);
  EXPECT_GT(readings_[1].sampled_at, 0);
}

TEST_F(IioBoardTest, ATemperatureIsReadWhereItIsWired) {
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

TEST_F(IioBoardTest, OffsetsCountBeforeTheScale) {
  put("iio:device1/out_voltage_offset", "-100");
  put("iio:device0/in_voltage0_offset", "800");
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok) << board.detail();
  ASSERT_EQ(exchange(board, 50, 25), BusStatus::ok) << board.detail();
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "2100");
  EXPECT_DOUBLE_EQ(readings_[0].displacement_mm, -5 + 12.5 * 1.1);
}

TEST_F(IioBoardTest, ValidityIsTheSensors) {
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok);
  put("iio:device0/in_voltage0_raw", "32767");
  ASSERT_EQ(exchange(board, 0, 0), BusStatus::ok);
  EXPECT_EQ(readings_[0].validity, Validity::out_of_range);
  EXPECT_EQ(readings_[1].validity, Validity::valid);
}

TEST_F(IioBoardTest, ACommandBeyondTheConverterIsReportedAndItsEndWritten) {
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok);
  EXPECT_EQ(exchange(board, 110, 10), BusStatus::write_refused);
  EXPECT_NE(std::string(board.detail()).find("left"), std::string::npos) << board.detail();
  EXPECT_EQ(get("iio:device1/out_voltage0_raw"), "4095");
  EXPECT_EQ(get("iio:device1/out_voltage1_raw"), "400");
  EXPECT_EQ(exchange(board, std::nan(""), 0), BusStatus::write_refused);
}

TEST_F(IioBoardTest, WhatIsNotThereIsSaid) {
  settings_.inputs[0].device = "ads1015";
  EXPECT_NE(refusal().find("there are "), std::string::npos);
  EXPECT_NE(refusal().find("ads1115"), std::string::npos) << refusal();
  settings_.inputs[0] = {"ads1115", "voltage7", 0};
  EXPECT_NE(refusal().find("in_voltage7_raw: No such file"), std::string::npos) << refusal();
  settings_.inputs[0] = {"ads1115", "voltage0", 0};
  fs::remove(root_ / "iio:device1/out_voltage_scale");
  EXPECT_NE(refusal().find("no scale"), std::string::npos) << refusal();
  settings_.root = (root_ / "absent").string();
  EXPECT_NE(refusal().find("no converter is there"), std::string::npos) << refusal();
}

TEST_F(IioBoardTest, AConverterThatShowsNoNumberEndsTheSession) {
  IioBoard board(settings_);
  ASSERT_EQ(board.connect(5s), BusStatus::ok);
  put("iio:device0/in_voltage0_raw", "no");
  EXPECT_EQ(exchange(board, 10, 10), BusStatus::disconnected);
  EXPECT_EQ(readings_[0].sequence, 0U) << "readings change all at once or not at all";
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

TEST(IioChannel, NamesAreVoltagesAndCurrents) {
  EXPECT_EQ(unit_of_channel("voltage0"), ElectricalUnit::volt);
  EXPECT_EQ(unit_of_channel("voltage0-voltage1"), ElectricalUnit::volt);
  EXPECT_EQ(unit_of_channel("current3"), ElectricalUnit::milliampere);
  for (const char* const other : {"", "voltage", "temp0", "../voltage0", "voltage0/..", "Voltage0"}) {
    EXPECT_FALSE(unit_of_channel(other).has_value()) << other;
  }
}

}  // namespace
}  // namespace softgrip::drivers::iio_board_test
