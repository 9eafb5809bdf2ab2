#include "tools/client/daemon_text.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace softgrip::tools::status_view_test {
namespace {

using Json = nlohmann::ordered_json;

Json channel(const std::string& name) {
  return Json::parse(
             R"({"command_kpa": 30.0, "pressure_kpa": 29.5, "displacement_mm": 12.25, "reference_mm": 12.5,
    "age_s": 0.0031, "validity": "valid", "result": "HOLDING", "evidence": "displacement", "saturated": false,
    "slewing": true, "health": "healthy",
    "limits": {"pressure_min_kpa": 0, "pressure_max_kpa": 60, "displacement_min_mm": 0, "displacement_max_mm": 25}})")
      .patch(Json::array({{{"op", "add"}, {"path", "/name"}, {"value", name}}}));
}

Json status() {
  Json status =
      Json::parse(R"({"rig": "bench", "rate_hz": 200, "time_s": 12.345, "state": "running", "fault": null,
    "sequence": {"name": "pick_stone", "request": 1, "step": 2, "step_name": "hold", "steps": 4, "ended": null},
    "bus": {"board": "ADAM-6024 at 127.0.0.1:1502 unit 1", "connected": true, "fault": null, "consecutive_failures": 0},
    "loop": {"ticks": 2469, "slips": 1, "wake_up_p99_us": 43.2, "wake_up_max_us": 120.0},
    "recording": {"active": true, "folder": "/tmp/run", "rows": 100, "dropped_rows": 0, "error": null},
    "real_time": {"degraded": true, "steps": []}})");
  status["channels"] = Json::array({channel("left"), channel("right")});
  return status;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

TEST(StatusView, ShowsResidualPressureFirstAndInFull) {
  Json pressed = status();
  pressed["state"] = "idle";
  pressed["under_pressure"] = {
      {"channels", Json::array()},
      {"command", "softgrip release"},
      {"text", "Fingers are pressurised: left 33.1 kPa. `softgrip release` vents them; a held part drops."}};
  const auto wide = view_of(pressed, {100, false, false});
  EXPECT_EQ(wide[0], "softgrip bench  idle, UNDER PRESSURE  pick_stone: step 3/4 hold  12.3 s");
  EXPECT_EQ(wide[1],
            "Fingers are pressurised: left 33.1 kPa. `softgrip release` vents them; a held part drops.");
  const auto narrow = view_of(pressed, {60, false, false});
  EXPECT_EQ(narrow[1], "  pick_stone: step 3/4 hold  12.3 s");
  EXPECT_EQ(narrow[2], "Fingers are pressurised: left 33.1 kPa. `softgrip release`");
  EXPECT_EQ(narrow[3], "vents them; a held part drops.");
  EXPECT_NE(line_of_status(pressed).find("idle, UNDER PRESSURE"), std::string::npos);
}

TEST(StatusView, ShowsATemperatureOnlyIfMeasured) {
  Json warm = status();
  EXPECT_EQ(joined(view_of(warm, {80, false, false})).find(" C\n"), std::string::npos);
  warm["channels"][1]["temperature_c"] = 23.46;
  const std::string text = joined(view_of(warm, {80, false, false}));
  EXPECT_NE(text.find("12.25 mm, reference 12.50, error 0.25, 23.5 C\n"), std::string::npos) << text;
}

TEST(StatusView, ShowsAMissingReadingAsADash) {
  Json blind = status();
  blind["channels"][0]["displacement_mm"] = nullptr;
  blind["channels"][0]["reference_mm"] = nullptr;
  blind["channels"][0]["age_s"] = nullptr;
  blind["channels"][0]["validity"] = "none_yet";
  const std::string text = joined(view_of(blind, {100, false, false}));
  EXPECT_NE(text.find("- mm, reference -\n"), std::string::npos) << text;
  EXPECT_NE(text.find("reading none_yet  model"), std::string::npos) << text;
}

TEST(StatusView, ShowsAnActiveLimitAndTheGrippingPressure) {
  Json bound = status();
  bound["channels"][0]["limit"] = "rig_pressure";
  bound["channels"][0]["limit_text"] = "pressure_max_kpa of the rig limits the pressure";
  bound["channels"][0]["squeeze_kpa"] = 5.04;
  const std::string text = joined(view_of(bound, {100, false, false}));
  EXPECT_NE(text.find("29.50 kPa, command 30.00, squeeze 5.0\n"), std::string::npos) << text;
  EXPECT_NE(text.find("                pressure_max_kpa of the rig limits the pressure\n"), std::string::npos)
      << text;
}

/// Returns the number of screen columns that a line occupies. An escape sequence occupies no column, and a
/// UTF-8 character occupies one column.
std::size_t columns_of(const std::string& line) {
  std::size_t columns = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '\x1b') {
      i = line.find('m', i);
    } else if ((static_cast<unsigned char>(line[i]) & 0xc0U) != 0x80U) {
      ++columns;
    }
  }
  return columns;
}

TEST(StatusView, PlainTextMatchesTheReference) {
  EXPECT_EQ(joined(view_of(status(), {100, false, false})),
            R"(softgrip bench  running  pick_stone: step 3/4 hold  12.3 s

left            HOLDING by displacement  reading valid, 3 ms old  model healthy  slewing
  pressure      [###################|                  ]  29.50 kPa, command 30.00
  displacement  [###################|                  ]  12.25 mm, reference 12.50, error 0.25

right           HOLDING by displacement  reading valid, 3 ms old  model healthy  slewing
  pressure      [###################|                  ]  29.50 kPa, command 30.00
  displacement  [###################|                  ]  12.25 mm, reference 12.50, error 0.25

board           ADAM-6024 at 127.0.0.1:1502 unit 1  connected
loop            200 Hz, 2469 ticks, 1 overruns, wake-up p99 43 us, max 120 us  real time degraded
recording       on   /tmp/run
)");
}

TEST(StatusView, NoLineIsLongerThanTheTerminal) {
  for (const std::size_t columns : {1U, 20U, 40U, 80U, 200U}) {
    for (const bool fancy : {false, true}) {
      for (const std::string& line : view_of(status(), {columns, fancy, fancy})) {
        EXPECT_LE(columns_of(line), columns) << line;
      }
    }
  }
}

TEST(StatusView, UsesColoursOnlyIfRequested) {
  EXPECT_EQ(joined(view_of(status(), {80, false, false})).find('\x1b'), std::string::npos);
  EXPECT_NE(joined(view_of(status(), {80, true, false})).find("\x1b[32m"), std::string::npos);
}

TEST(StatusView, ShowsAFaultWithCauseAndRemedy) {
  Json faulted = status();
  faulted["state"] = "faulted";
  faulted["fault"] = {{"code", "F101"},
                      {"name", "bus_down"},
                      {"meaning", "No session."},
                      {"cause", "A cable."},
                      {"remedy", "Look."}};
  const std::string text = joined(view_of(faulted, {80, false, false}));
  EXPECT_NE(text.find("F101"), std::string::npos);
  EXPECT_NE(text.find("usual cause: A cable."), std::string::npos);
  EXPECT_NE(text.find("remedy: Look."), std::string::npos);
  EXPECT_NE(line_of_status(faulted).find("faulted F101"), std::string::npos);
}

TEST(StatusView, AFaultNamesTheChannelAndTheCommandThatClearsIt) {
  Json faulted = status();
  faulted["state"] = "faulted";
  faulted["fault"] = {{"code", "F202"},
                      {"name", "reading_out_of_range"},
                      {"meaning", "The signal was outside its range."},
                      {"cause", "A wire."},
                      {"remedy", "Look."},
                      {"channel", "left"},
                      {"present", nullptr},
                      {"next", "The cause is gone: `softgrip acknowledge` clears the fault."}};
  const std::string text = joined(view_of(faulted, {100, false, false}));
  EXPECT_NE(text.find("fault F202 of left  reading_out_of_range: The signal was outside its range.\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("  The cause is gone: `softgrip acknowledge` clears the fault.\n"), std::string::npos)
      << text;
  EXPECT_NE(line_of_status(faulted).find("faulted F202 of left"), std::string::npos);
}

TEST(StatusView, ShowsConnectionAttemptsToABoardThatDoesNotRespond) {
  Json away = status();
  away["bus"] = {{"board", "ADAM-6024 at 127.0.0.1:1502 unit 1"},
                 {"connected", false},
                 {"answered", false},
                 {"attempts", 14},
                 {"retry_s", 2.0},
                 {"failure", "The exchange with the board failed: disconnected: Connection refused."}};
  const std::string text = joined(view_of(away, {200, false, false}));
  EXPECT_NE(text.find("no response yet: 14 connection attempts, one every 2 s. The exchange with "
                      "the board failed: disconnected: Connection refused.\n"),
            std::string::npos)
      << text;
  away["bus"]["answered"] = true;
  EXPECT_NE(joined(view_of(away, {200, false, false})).find("                lost: 14 connection"),
            std::string::npos);
  EXPECT_NE(line_of_status(away).find("board NOT CONNECTED"), std::string::npos);
}

/// Returns the text of a view with a width of `columns`. Replaces every sequence of blanks and line breaks by
/// one blank.
std::string words_at(std::size_t columns, const Json& shown) {
  std::string text;
  for (const char c : joined(view_of(shown, {columns, false, false}))) {
    const bool blank = c == ' ' || c == '\n';
    if (!blank || (!text.empty() && text.back() != ' ')) text += blank ? ' ' : c;
  }
  return text;
}

TEST(StatusView, ShowsAllPhrasesAtSixtyColumns) {
  Json full = status();
  for (Json& each : full["channels"]) {
    each["squeeze_kpa"] = 5.0;
    each["limit_text"] = "slew_down_kpa_per_s of the rig limits the rate of the pressure";
    each["saturated"] = true;
  }
  for (const char* phrase :
       {"29.50 kPa, command 30.00, squeeze 5.0", "12.25 mm, reference 12.50, error 0.25", "slewing",
        "saturated", "limits the rate of the pressure", "real time degraded", "12.3 s", "connected"}) {
    EXPECT_NE(words_at(60, full).find(phrase), std::string::npos) << phrase << "\n" << words_at(60, full);
  }
}

TEST(StatusView, AChannelFitsIntoThreeLinesOfEightyColumns) {
  Json holding = status();
  holding["channels"][0]["slewing"] = false;
  const std::vector<ChannelTrends> trends(2);
  EXPECT_EQ(parts_of(holding, {80, false, false}, &trends).channels[0].size(), 3U);
}

TEST(StatusView, MarksALongWordThatIsCutOff) {
  Json deep = status();
  deep["recording"]["folder"] = std::string(80, 'x');
  for (const std::string& line : view_of(deep, {60, false, false})) {
    if (line.find("xx") == std::string::npos) continue;
    EXPECT_EQ(line, std::string(16, ' ') + std::string(43, 'x') + ">");
  }
  EXPECT_NE(joined(view_of(deep, {60, false, true})).find("x…\n"), std::string::npos);
}

TEST(StatusView, ShowsUnknownValuesAsDashesAndToleratesMalformedStatus) {
  Json unknown = status();
  for (Json& each : unknown["channels"]) {
    each["pressure_kpa"] = nullptr;
    each["reference_mm"] = nullptr;
    each["result"] = "-";
  }
  unknown["sequence"] = nullptr;
  const std::string text = joined(view_of(unknown, {100, false, false}));
  EXPECT_NE(text.find("- kPa, command 30.00"), std::string::npos);
  EXPECT_NE(text.find("12.25 mm, reference -"), std::string::npos);
  EXPECT_EQ(text.find("error"), std::string::npos);
  for (const Json& nonsense : {Json::object(), Json::parse(R"({"channels": 3, "bus": "x", "fault": 1})")}) {
    EXPECT_FALSE(view_of(nonsense, {80, false, false}).empty());
    EXPECT_FALSE(line_of_status(nonsense).empty());
  }
}

TEST(StatusView, RemovesControlCharactersFromReceivedText) {
  Json hostile = status();
  hostile["rig"] = "\x1b[2Jboo";
  hostile["channels"][0]["name"] = "a\nb";
  const std::string text = joined(view_of(hostile, {80, false, false}));
  EXPECT_EQ(text.find('\x1b'), std::string::npos);
  EXPECT_EQ(text.find("a\nb"), std::string::npos);
}

TEST(StatusView, OneLineSummarisesStateCommandAndReadingOfEachChannel) {
  EXPECT_EQ(line_of_status(status()),
            "12.35 s  running  left 30.00 kPa 12.25 mm of 12.50 HOLDING  right 30.00 kPa 12.25 mm of 12.50 "
            "HOLDING");
}

}  // namespace
}  // namespace softgrip::tools::status_view_test
