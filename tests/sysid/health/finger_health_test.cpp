#include "sysid/health/finger_health.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "base/numbers.h"
#include "sysid/changes/next_steps.h"
#include "sysid/diagnosis/causes/cause.h"
#include "sysid/health/health_page.h"
#include "sysid/health/health_result.h"
#include "sysid/health/rig_health.h"

namespace softgrip::sysid::health::finger_health_test {
namespace {

using sysid::HealthNumber;

const ScoreBase base{{}, 60, 32};

std::string day_text(int day) {
  const std::string two = std::to_string(day % 28 + 1);
  return "2026-0" + std::to_string(day / 28 + 1) + "-" + (two.size() < 2 ? "0" : "") + two;
}

/// A finger that performs three grips of one recipe per day. From day `from_day` on, `change` is added to its
/// indicators.
struct Life {
  int days = 30;
  int from_day = 1000;
  GripScore change = [] {
    GripScore none;
    none.values.fill(0);
    return none;
  }();
  std::string recipe = "pick";
  unsigned seed = 1;

  [[nodiscard]] std::vector<ScoredRun> runs() const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    constexpr std::array<double, sysid::health_numbers> usual{32, 0, 0.005, 0, 0, 0, 0, 12, 5.9};
    constexpr std::array<double, sysid::health_numbers> spread{0.2,  0.05, 0.004, 0.05, 0.05,
                                                               0.15, 0.03, 0.05,  0.03};
    std::vector<ScoredRun> made;
    for (int day = 0; day < days; ++day) {
      for (int grip = 0; grip < 3; ++grip) {
        ScoredRun run;
        run.started_at = day_text(day) + "T0" + std::to_string(6 + grip) + ":00:00Z";
        run.run = run.started_at + "_pick";
        run.finger = "left";
        run.recipe = recipe;
        for (std::size_t i = 0; i < sysid::health_numbers; ++i)
          run.score.values[i] =
              usual[i] + spread[i] * normal(random) + (day >= from_day ? change.values[i] : 0);
        made.push_back(std::move(run));
      }
    }
    return made;
  }
};

Life changed(std::initializer_list<std::pair<HealthNumber, double>> changes) {
  Life life;
  life.from_day = 20;
  for (const auto& [number, by] : changes) life.change[number] = by;
  return life;
}

FingerHealth judged(const Life& life, const std::vector<Note>& notes = {}) {
  return judge_finger("left", life.runs(), notes, base, {});
}

// Each finger has 9 charts. The stated rate is one alarm in 3650 points, over all charts of a finger. For 400
// fingers in 60 days, 6.6 alarms are expected.
TEST(FingerHealth, HealthyFingerAlarmsNoMoreOftenThanStated) {
  int alarms = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    Life life;
    life.days = 60;
    life.seed = seed;
    alarms += judged(life).state == FingerState::alarm ? 1 : 0;
  }
  EXPECT_LE(alarms, 14);  // expected number of alarms plus three standard errors
  EXPECT_GE(alarms, 1);
  RecordProperty("alarms_in_400_lives", alarms);
}

TEST(FingerHealth, HealthyFingerIsSteady) {
  EXPECT_EQ(judged({}).state, FingerState::steady);
}

TEST(FingerHealth, StateIsLearningWithTooFewGrips) {
  Life life;
  life.days = 2;
  const FingerHealth health = judged(life);
  EXPECT_EQ(health.state, FingerState::learning);
  EXPECT_NE(health_sentence(health, {}).find("too few grips"), std::string::npos);
}

TEST(FingerHealth, TheSentenceStatesThatGainAndLagWereNeverComputed) {
  EXPECT_EQ(health_sentence(judged({}), {}), "No indicator has changed at left.");
  Life life;
  life.from_day = 0;
  life.change[HealthNumber::gain] = NAN;
  EXPECT_EQ(health_sentence(judged(life), {}), "No indicator has changed at left.");
  life.change[HealthNumber::lag] = NAN;
  const FingerHealth health = judged(life);
  EXPECT_EQ(health.state, FingerState::steady);
  EXPECT_EQ(
      health_sentence(health, {}),
      "No grip of left contains enough free motion for the gain and the lag, so a change of them cannot "
      "be detected. The other indicators have not changed.");
}

TEST(FingerHealth, GripsOfOneDayFormOnePoint) {
  const FingerHealth health = judged({});
  ASSERT_EQ(health.points.size(), 30U);
  EXPECT_EQ(health.points[4].label, "2026-01-05");
  EXPECT_EQ(health.points[4].grips, 3U);
  const FingerHealth single = judge_finger("left", Life{}.runs(), {}, base, {.by_day = false});
  EXPECT_EQ(single.points.size(), 90U);
}

TEST(FingerHealth, RunsAreSortedByStartTime) {
  std::vector<ScoredRun> runs = changed({{HealthNumber::gain, -2}}).runs();
  std::reverse(runs.begin(), runs.end());
  const FingerHealth health = judge_finger("left", runs, {}, base, {});
  ASSERT_EQ(health.alarms.size(), 1U);
  EXPECT_EQ(health.points[health.alarms[0].since].label, day_text(20));
}

TEST(FingerHealth, AlarmStatesStartSizeAndNumberOfGrips) {
  const FingerHealth health = judged(changed({{HealthNumber::gain, -2}}));
  EXPECT_EQ(health.state, FingerState::alarm);
  ASSERT_EQ(health.alarms.size(), 1U);
  EXPECT_EQ(health.alarms[0].number, HealthNumber::gain);
  EXPECT_NEAR(health.alarms[0].change, -2, 0.2);
  EXPECT_EQ(health.alarms[0].since, 20U);
  EXPECT_EQ(health.alarms[0].grips, 3 * (health.alarms[0].noticed - 19));
  EXPECT_NEAR(health.latest(HealthNumber::gain).value_or(0), 30, 0.5);
  EXPECT_NEAR(health.references[0]->mean, 32, 0.2);
}

TEST(FingerHealth, MaintenanceRestartsTheChartsOfTheFinger) {
  const Life life = changed({{HealthNumber::gain, -2}});
  const std::vector<Note> notes{{day_text(20), "left", "finger replaced"}};
  const FingerHealth health = judged(life, notes);
  EXPECT_EQ(health.state, FingerState::steady);
  EXPECT_EQ(health.epoch(), 1U);
  ASSERT_EQ(health.notes.size(), 1U);
  EXPECT_EQ(health.notes[0].first, 20U);
  EXPECT_NEAR(health.references[0]->mean, 30, 0.2);
  // A maintenance record of another finger must have no effect on this finger.
  EXPECT_EQ(judged(life, {{day_text(20), "right", "finger replaced"}}).state, FingerState::alarm);
  EXPECT_EQ(judged(life, {{day_text(20), "", "all fingers replaced"}}).state, FingerState::steady);
}

TEST(FingerHealth, AlarmBeforeMaintenanceIsListedButNotActive) {
  const FingerHealth health =
      judged(changed({{HealthNumber::gain, -2}}), {{day_text(25), "left", "finger replaced"}});
  ASSERT_EQ(health.alarms.size(), 1U);
  EXPECT_TRUE(health.standing().empty());
  EXPECT_EQ(health.state, FingerState::steady);
}

TEST(FingerHealth, NewRecipeRaisesNoAlarm) {
  std::vector<ScoredRun> runs = Life{}.runs();
  Life other = changed({{HealthNumber::contact, -6}, {HealthNumber::time_to_grip, 4}});
  other.from_day = 0;
  other.recipe = "screw";
  for (ScoredRun& run : other.runs()) {
    if (run.started_at > day_text(15)) runs.push_back(run);
  }
  EXPECT_EQ(judge_finger("left", runs, {}, base, {}).state, FingerState::steady);
}

TEST(FingerHealth, IndicatorWithoutRecordingIsNullInJson) {
  std::vector<ScoredRun> runs = Life{}.runs();
  for (ScoredRun& run : runs) run.score[HealthNumber::leak] = NAN;
  const FingerHealth health = judge_finger("left", runs, {}, base, {});
  EXPECT_FALSE(health.latest(HealthNumber::leak));
  const auto json = result::json_of(fields_of(health, suspicion_of(health)));
  EXPECT_TRUE(json["numbers"]["leak_kpa_per_s"]["value"].is_null());
  EXPECT_TRUE(json["numbers"]["leak_kpa_per_s"]["reference"].is_null());
  EXPECT_TRUE(json["numbers"]["gain_mm"]["value"].is_number());
}

TEST(FingerHealth, DeprecatedKeysHaveTheValuesOfTheirReplacements) {
  FingerHealth health = judged(changed({{HealthNumber::gain, -2}}));
  health.notes = {{health.points.size(), {"2026-11-03", "left", "finger replaced"}}};
  const auto json = result::json_of(fields_of(health, suspicion_of(health)));
  EXPECT_EQ(json["notes"][0]["action"], "finger replaced");
  EXPECT_EQ(json["notes"][0]["mended"], json["notes"][0]["action"]);
  ASSERT_FALSE(json["alarms"].empty());
  EXPECT_EQ(json["alarms"][0]["active"], true);
  EXPECT_EQ(json["alarms"][0]["stands"], true);
  for (const bool active : {true, false}) {
    SharedChange shared;
    shared.stands = active;
    const auto change = result::json_of(fields_of(shared));
    EXPECT_EQ(change["active"], active);
    EXPECT_EQ(change["stands"], active);
  }
}

TEST(FingerHealth, SharedChangesNeedTheSameSignInAllFingers) {
  const FingerHealth healthy = judged({});
  const FingerHealth less = judged(changed({{HealthNumber::gain, -2}, {HealthNumber::zero, 1}}));
  const FingerHealth also = judged(changed({{HealthNumber::gain, -3}, {HealthNumber::zero, -1}}));
  EXPECT_EQ(shared_changes({&less, &also}), std::vector{HealthNumber::gain});
  EXPECT_TRUE(shared_changes({&less, &also, &healthy}).empty());
  EXPECT_TRUE(shared_changes({&less}).empty());
  EXPECT_TRUE(shared_changes({}).empty());
}

std::string first_suspect(const Life& life) {
  const Suspicion suspicion = suspicion_of(judged(life));
  return suspicion.suspects.empty() ? "" : suspicion.suspects.front().id;
}

TEST(Suspicion, NamesTheCauseWithMatchingSymptoms) {
  EXPECT_EQ(first_suspect(changed({{HealthNumber::gain, -2}})), "ageing");
  EXPECT_EQ(first_suspect(changed({{HealthNumber::gain, -2}, {HealthNumber::pressure_loss, 2}})), "leak");
  EXPECT_EQ(first_suspect(changed({{HealthNumber::zero, 0.5}, {HealthNumber::contact, 0.5}})),
            "sensor_drift");
  EXPECT_EQ(first_suspect(changed({{HealthNumber::creep, 0.5}})), "slow_creep");
  EXPECT_EQ(first_suspect(changed({{HealthNumber::contact, -1}})), "contact");
  EXPECT_EQ(first_suspect({}), "");
}

TEST(Suspicion, ListsAllEquallyLikelyCausesWithNextSteps) {
  const Suspicion suspicion = suspicion_of(judged(changed({{HealthNumber::lag, 0.1}})));
  std::vector<std::string> ids;
  for (const Suspect& suspect : suspicion.suspects) {
    ids.push_back(suspect.id);
    EXPECT_EQ(suspect.next_steps.size(), 2U);
    EXPECT_FALSE(suspect.words.empty());
  }
  for (const char* id : {"transport_delay", "valve_lag", "sensor_lag", "blocked_line"})
    EXPECT_NE(std::find(ids.begin(), ids.end(), id), ids.end()) << id;
}

TEST(Suspicion, ChangeInTheWrongDirectionIsNoSymptom) {
  EXPECT_EQ(first_suspect(changed({{HealthNumber::creep, -0.5}})), "");
  const FingerHealth health = judged(changed({{HealthNumber::creep, -0.5}}));
  EXPECT_NE(health_sentence(health, suspicion_of(health)).find("No known cause"), std::string::npos);
}

TEST(Suspicion, TimeToGripIsIgnoredIfAnotherIndicatorAlarms) {
  EXPECT_EQ(first_suspect(changed({{HealthNumber::zero, 0.5}, {HealthNumber::time_to_grip, 1}})),
            "sensor_drift");
}

TEST(Suspicion, EveryCauseWithSymptomsCanBeNamed) {
  for (const std::string_view id : sysid::changes()) {
    Life life;
    life.from_day = 20;
    bool any = false;
    for (const sysid::HealthSign& sign : sysid::signs_of(id)) {
      if (sign.moves == sysid::Moves::not_at_all) continue;
      EXPECT_EQ(life.change[sign.number], 0) << id;
      life.change[sign.number] = sign.moves == sysid::Moves::down ? -3 : 3;
      any = true;
    }
    if (!any) continue;
    const Suspicion suspicion = suspicion_of(judged(life));
    EXPECT_TRUE(std::any_of(suspicion.suspects.begin(), suspicion.suspects.end(),
                            [&](const Suspect& suspect) { return suspect.id == id; }))
        << id;
  }
}

TEST(HealthPage, ShowsVerdictAlarmAndEscapedMaintenanceNotes) {
  const FingerHealth health = judged(changed({{HealthNumber::gain, -2}, {HealthNumber::pressure_loss, 2}}),
                                     {{day_text(5), "left", "sensor <clamped> again"}});
  const std::string html = health_page(health, suspicion_of(health), {"finger-3", base, {}}).to_html();
  for (const char* text : {"the pressure falls while it should be constant", "soapy water", "finger-3",
                           "sensor &lt;clamped&gt; again", "gain (at full pressure)", "one in 3650 points"})
    EXPECT_NE(html.find(text), std::string::npos) << text;
  EXPECT_EQ(html.find("<clamped>"), std::string::npos);
}

TEST(HealthPage, FingerWithoutIndicatorsHasAPage) {
  std::vector<ScoredRun> runs = Life{}.runs();
  for (ScoredRun& run : runs) run.score = GripScore();
  const FingerHealth health = judge_finger("left", runs, {}, base, {});
  EXPECT_EQ(health.state, FingerState::learning);
  EXPECT_NE(health_page(health, suspicion_of(health), {"b", base, {}}).to_html().find("too few grips"),
            std::string::npos);
}

}  // namespace
}  // namespace softgrip::sysid::health::finger_health_test
