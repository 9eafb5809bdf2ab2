// Tests the rig files that softgrip init writes. For any answers of the user, the reader of rig files must
// accept the written file.

#include "tools/commissioning/rig_draft.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "base/files.h"
#include "rig/check.h"
#include "rig/rig_file.h"
#include "tools/commissioning/rig_template.h"

namespace softgrip::tools::rig_draft_test {
namespace {

const std::string config = std::string(SOFTGRIP_SOURCE_DIR) + "/config/";
const std::string path = std::string(SOFTGRIP_SOURCE_DIR) + "/config/drafted.yaml";

std::string take(RigDraft& draft, const std::string& key, const std::string& words) {
  for (const Fact& fact : draft_facts()) {
    if (fact.key == key) return fact.take(words, draft);
  }
  return "the rig draft has no question with the key " + key;
}

/// Returns a rig-file draft with the given values. All other values of the draft are defaults.
RigDraft draft_of(const std::map<std::string, std::string>& given) {
  RigDraft draft;
  draft.sequences_path = config + "sequences";
  for (const Fact& fact : draft_facts()) {
    const auto question = fact.question(draft);
    const auto found = given.find(fact.key);
    if (found == given.end() && !question) {
      if (fact.key == "monitor") draft.monitor = false;
      continue;
    }
    EXPECT_EQ(fact.take(found != given.end() ? found->second : question->otherwise, draft), "") << fact.key;
  }
  return draft;
}

std::string map_of(const std::string& name) {
  return config + "boards/" + name + ".yaml";
}
const std::map<std::string, std::string> twin{{"model", config + "models/bench_twin.yaml"}};

std::map<std::string, std::string> with(std::map<std::string, std::string> given) {
  given.insert(twin.begin(), twin.end());
  return given;
}

class RigDraftTest : public ::testing::Test {
 protected:
  rig::RigFile read(const RigDraft& draft) {
    const auto text = draft_text(draft, path);
    EXPECT_TRUE(text) << text.error().format();
    if (!text) return {};
    text_ = *text;
    EXPECT_EQ(text_.find('$'), std::string::npos) << text_;
    document::Problems problems;
    const document::Document document = document::parse(path, text_, problems);
    auto rig = rig::read_rig(document, problems);
    if (rig) rig::compare_limits(document, *rig, problems);
    warnings_ = problems.format();
    return rig.value_or(rig::RigFile{});
  }
  std::string text_;
  std::string warnings_;
};

TEST_F(RigDraftTest, DraftsAValidRigForATcpBoard) {
  const rig::RigFile rig =
      read(draft_of(with({{"board", map_of("adam-6024")}, {"address", "192.168.1.20:1502"}})));
  EXPECT_EQ(warnings_, "");
  ASSERT_EQ(rig.settings.channels.size(), 2U);
  EXPECT_EQ(rig.settings.channels[0].feedforward.kind, control::FeedforwardKind::full_model);
  EXPECT_EQ(rig.wiring[1].pressure->input, 5U);
  const auto& board = std::get<drivers::ModbusSettings>(rig.board);
  EXPECT_EQ(std::get<drivers::TcpAddress>(board.links[0]), (drivers::TcpAddress{"192.168.1.20", 1502}));
  EXPECT_LT(rig.settings.rate_hz, 50) << "the network limits the cycle rate";
  EXPECT_NE(text_.find("map: boards/adam-6024.yaml\n"), std::string::npos)
      << "the path is relative to the rig file";
  EXPECT_NE(text_.find("channel_defaults:"), std::string::npos);
}

TEST_F(RigDraftTest, DraftsAValidRigForTwoSerialModulesWithoutWatchdog) {
  const auto given = with({{"board", map_of("waveshare-ao8") + " " + map_of("waveshare-ai8")},
                           {"address", "/dev/serial/by-id/adapter"},
                           {"baud", "115200"},
                           {"finger", "a b c d"},
                           {"accept-no-watchdog", "yes"}});
  const rig::RigFile rig = read(draft_of(given));
  EXPECT_EQ(warnings_, "");
  ASSERT_EQ(rig.settings.channels.size(), 4U);
  EXPECT_EQ(rig.wiring[3].valve.unit, drivers::ElectricalUnit::milliampere);
  EXPECT_EQ(rig.wiring[3].pressure->input, 7U);
  EXPECT_FALSE(rig.accept_no_watchdog.empty());
}

TEST_F(RigDraftTest, RefusesABoardWithoutWatchdogUnlessAccepted) {
  RigDraft draft = draft_of(with({{"board", map_of("waveshare-ao8") + " " + map_of("waveshare-ai8")},
                                  {"address", "127.0.0.1"},
                                  {"accept-no-watchdog", "yes"}}));
  draft.accepts_no_watchdog = false;
  const auto text = draft_text(draft, path);
  ASSERT_FALSE(text);
  EXPECT_NE(text.error().format().find("does not vent by itself"), std::string::npos);
}

TEST_F(RigDraftTest, DraftsAValidRigForEveryShippedBoardAndModel) {
  int boards = 0;
  for (const auto& board : std::filesystem::directory_iterator(config + "boards")) {
    for (const auto& model : std::filesystem::directory_iterator(config + "models")) {
      RigDraft draft;
      if (!take(draft, "board", board.path().string()).empty())
        continue;  // skip a board without inputs or
                   // without outputs
      const bool watched = has_watchdog(draft);
      std::map<std::string, std::string> given{{"board", board.path().string()},
                                               {"address", "127.0.0.1"},
                                               {"finger", "only"},
                                               {"model", model.path().string()}};
      if (!watched) given["accept-no-watchdog"] = "yes";
      SCOPED_TRACE(board.path().string() + " " + model.path().string());
      EXPECT_EQ(read(draft_of(given)).settings.channels.size(), 1U);
      ++boards;
    }
  }
  EXPECT_GE(boards, 6);
}

TEST_F(RigDraftTest, DraftsAValidSimulatedRig) {
  const rig::RigFile rig =
      read(draft_of(with({{"board", "simulated"}, {"finger", "thumb"}, {"pressure-max-kpa", "45"}})));
  EXPECT_EQ(warnings_, "");
  EXPECT_EQ(rig.settings.channels[0].name, "thumb");
  EXPECT_EQ(rig.settings.channels[0].limits.pressure_max_kpa, 45);
  EXPECT_EQ(rig.settings.rate_hz, 200);
}

TEST_F(RigDraftTest, AppliesAFallingSensorCharacteristicAndAValveRange) {
  const rig::RigFile rig = read(draft_of(with({{"board", map_of("adam-6024")},
                                               {"address", "127.0.0.1"},
                                               {"valve-kpa", "5 500"},
                                               {"pressure-max-kpa", "80"},
                                               {"sensor-mm", "60 0"},
                                               {"monitor", "no"}})));
  EXPECT_LT(rig.wiring[0].displacement.scaling.y_at(10), rig.wiring[0].displacement.scaling.y_at(0));
  EXPECT_EQ(rig.settings.channels[0].limits.pressure_min_kpa, 5);
  EXPECT_FALSE(rig.wiring[0].pressure);
}

/// The rig file states the limits with four decimals. A limit at the end of the valve's range must not exceed
/// this range.
TEST_F(RigDraftTest, AcceptsLimitsAtTheEndsOfTheRangeOfTheValve) {
  for (const auto& [valve, most] : std::vector<std::pair<std::string, std::string>>{
           {"0 13.7895", ""}, {"0 13.78957", ""}, {"0 68.9476", "68.9476"}, {"0.344 100", "60"}}) {
    SCOPED_TRACE(valve);
    auto given = with({{"board", "simulated"}, {"valve-kpa", valve}});
    if (!most.empty()) given["pressure-max-kpa"] = most;
    const rig::RigFile rig = read(draft_of(given));
    ASSERT_EQ(rig.settings.channels.size(), 2U);
    EXPECT_GE(rig.settings.channels[0].limits.pressure_min_kpa, rig.valves[0].range_min_kpa);
    EXPECT_LE(rig.settings.channels[0].limits.pressure_max_kpa, rig.valves[0].range_max_kpa);
  }
}

TEST_F(RigDraftTest, PutsPathsInQuotesIfYamlRequiresThem) {
  const ScratchFolder scratch;
  for (const std::string name : {"a, b", "a #b", "it's: {a}", "müller"}) {
    SCOPED_TRACE(name);
    const std::filesystem::path folder = std::filesystem::path(scratch.path()) / name;
    std::filesystem::create_directory(folder);
    const std::string model = (folder / "m.yaml").string(), board = (folder / "b.yaml").string();
    std::filesystem::copy_file(config + "models/bench_twin.yaml", model);
    std::filesystem::copy_file(map_of("adam-6024"), board);
    RigDraft draft = draft_of({{"board", "simulated"}, {"model", model}});
    draft.sequences_path = folder.string();
    const rig::RigFile rig = read(draft);
    ASSERT_EQ(rig.settings.channels.size(), 2U);
    EXPECT_EQ(rig.socket.sequence_directory, folder.string());
    draft = draft_of(with({{"board", map_of("adam-6024")}, {"address", "127.0.0.1"}}));
    draft.modules[0].path = board;
    EXPECT_EQ(read(draft).settings.channels.size(), 2U);
  }
}

TEST(DraftFacts, ErrorStatesWhyAnAnswerIsRefused) {
  std::filesystem::current_path(SOFTGRIP_SOURCE_DIR);  // the test gives the paths of boards and models
                                                       // relative to this folder
  RigDraft draft;
  EXPECT_NE(take(draft, "board", "adam-6042").find("did you mean adam-6024?"), std::string::npos)
      << take(draft, "board", "adam-6042");
  EXPECT_NE(take(draft, "board", map_of("waveshare-ao8")).find("add a module"), std::string::npos);
  EXPECT_EQ(take(draft, "board", map_of("adam-6024")), "");
  EXPECT_NE(take(draft, "address", "localhost").find("127.0.0.1"), std::string::npos);
  EXPECT_NE(take(draft, "address", "10.0.0.1:99999"), "");
  EXPECT_NE(take(draft, "finger", "a b c").find("for 2 fingers"), std::string::npos);
  EXPECT_NE(take(draft, "finger", "a a").find("two fingers"), std::string::npos);
  EXPECT_NE(take(draft, "unit", "one"), "");
  EXPECT_NE(take(draft, "valve-kpa", "100"), "");
  EXPECT_NE(take(draft, "valve-kpa", "0 0"), "");
  EXPECT_NE(take(draft, "valve-kpa", "100 0").find("Enter 0 100"), std::string::npos);
  EXPECT_NE(take(draft, "sensor-mm", "-0.005 0.045").find("in mm"), std::string::npos);
  EXPECT_EQ(take(draft, "valve-kpa", "0 6,5"), "") << "a decimal comma is accepted";
  EXPECT_NE(take(draft, "pressure-max-kpa", "60").find("at most 6.5"), std::string::npos);
  EXPECT_NE(take(draft, "monitor", "perhaps"), "");
}

TEST(DraftFacts, TheTemplateHasChannelDefaultsAndNoTabs) {
  EXPECT_NE(rig_template.find("channel_defaults:"), std::string_view::npos);
  EXPECT_EQ(rig_template.find("\t"), std::string_view::npos);
}

}  // namespace
}  // namespace softgrip::tools::rig_draft_test
