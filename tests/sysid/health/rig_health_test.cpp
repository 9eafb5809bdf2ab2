#include "sysid/health/rig_health.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <random>

#include "sysid/health/finger_track.h"
#include "sysid/health/health_page.h"
#include "sysid/health/health_result.h"
#include "sysid/health/number_watch.h"

namespace softgrip::sysid::health::rig_health_test {
namespace {

using sysid::HealthNumber;

const ScoreBase base{{}, 60, 32};
constexpr int days = 80;

std::string day_text(int day) {
  const std::string two = std::to_string(day % 28 + 1);
  return "2026-0" + std::to_string(day / 28 + 1) + "-" + (two.size() < 2 ? "0" : "") + two;
}

/// Two fingers that perform three grips per day. The weather changes the gain of both fingers with a standard
/// deviation of `weather_mm`. An effect of the weather lasts for days.
struct Rig {
  unsigned seed = 1;
  double weather_mm = 0.12;
  bool thermometer = false;
  double uneven = 1;  ///< factor that scales the effect of the weather on the last finger
  std::vector<std::string> names{"left", "right"};
  /// Returns the change of an indicator on a given day, in the unit of the indicator.
  std::function<double(const std::string& finger, HealthNumber number, int day)> becomes =
      [](const std::string&, HealthNumber, int) { return 0.0; };

  [[nodiscard]] std::vector<FingerRuns> fingers() const {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<FingerRuns> made;
    for (const std::string& name : names) made.push_back({name, {}, base});
    double weather = normal(random);
    for (int day = 0; day < days; ++day) {
      weather = 0.7 * weather + std::sqrt(1 - 0.49) * normal(random);
      for (int grip = 0; grip < 3; ++grip) {
        for (FingerRuns& finger : made) {
          ScoredRun run;
          run.started_at = day_text(day) + "T0" + std::to_string(6 + grip) + ":00:00Z";
          run.run = run.started_at + "_pick";
          run.finger = finger.finger;
          run.recipe = "pick";
          const double follows = &finger == &made.back() ? uneven : 1;
          run.score[HealthNumber::gain] = 32 + follows * weather_mm * weather + 0.03 * normal(random);
          run.score[HealthNumber::zero] = 0.01 * normal(random);
          run.score[HealthNumber::pressure_loss] = 0.1 + 0.05 * normal(random);
          for (const auto number : {HealthNumber::gain, HealthNumber::zero, HealthNumber::pressure_loss})
            run.score[number] += becomes(finger.finger, number, day);
          if (thermometer) run.temperature_c = 20 + 2 * weather + 0.2 * normal(random);
          finger.runs.push_back(std::move(run));
        }
      }
    }
    return made;
  }
  [[nodiscard]] RigHealth judged(const std::vector<Note>& notes = {}) const {
    return judge_rig(fingers(), notes, {});
  }
};

/// Returns a rig whose left finger changes from day `from` on. From this day on, the gain indicator of the
/// left finger changes by `by` [mm] per day.
Rig softening(unsigned seed, double by, int from) {
  Rig rig;
  rig.seed = seed;
  rig.becomes = [=](const std::string& finger, HealthNumber number, int day) {
    return finger == "left" && number == HealthNumber::gain && day >= from ? by * (day - from + 1) : 0;
  };
  return rig;
}

std::size_t alarms_of(const RigHealth& rig) {
  std::size_t alarms = 0;
  for (const FingerHealth& finger : rig.fingers) alarms += finger.alarms.size();
  return alarms;
}

// The 200 fingers have 16,000 points, so 4.4 alarms are expected at the stated rate. If a finger were judged
// without its peer fingers, the weather would cause more alarms.
TEST(RigHealth, WeatherRaisesFewAlarmsWithPeerFingers) {
  std::size_t together = 0, alone = 0, warm = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    Rig rig;
    rig.seed = seed;
    together += alarms_of(rig.judged());
    for (const FingerRuns& finger : rig.fingers())
      alone += judge_finger(finger.finger, finger.runs, {}, base, {}).alarms.size();
    rig.thermometer = true;
    warm += alarms_of(rig.judged());
  }
  RecordProperty("together", static_cast<int>(together));
  RecordProperty("alone", static_cast<int>(alone));
  RecordProperty("with_temperature", static_cast<int>(warm));
  EXPECT_LE(together, 10U);
  EXPECT_LE(warm, 10U);
  EXPECT_GE(alone, 15U);
}

TEST(RigHealth, UnequalWeatherSensitivityRaisesFewAlarms) {
  std::size_t blind = 0, warm = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    Rig rig;
    rig.seed = seed;
    rig.uneven = 1.3;
    blind += alarms_of(rig.judged());
    rig.thermometer = true;
    warm += alarms_of(rig.judged());
  }
  RecordProperty("without_temperature", static_cast<int>(blind));
  RecordProperty("with_temperature", static_cast<int>(warm));
  EXPECT_LE(blind, 10U);
  EXPECT_LE(warm, 10U);
}

TEST(RigHealth, ChangedFingerIsFoundWithoutAlarmsOfThePeer) {
  std::vector<int> delays;
  int false_alarms = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    const RigHealth rig = softening(seed, -0.1, 60).judged();
    for (const HealthAlarm& alarm : rig.fingers[0].alarms) {
      if (alarm.noticed < 60) continue;
      EXPECT_LT(alarm.change, 0);
      delays.push_back(static_cast<int>(alarm.noticed) - 60 + 1);
    }
    false_alarms += rig.fingers[1].alarms.empty() ? 0 : 1;
  }
  std::sort(delays.begin(), delays.end());
  EXPECT_GE(delays.size(), 58U);
  EXPECT_LE(delays[delays.size() / 2], 8);
  EXPECT_LE(false_alarms, 3);
}

TEST(RigHealth, AlarmListsThePeerFingersOfTheComparison) {
  const RigHealth rig = softening(4, -0.1, 60).judged();
  ASSERT_FALSE(rig.fingers[0].alarms.empty());
  EXPECT_EQ(rig.fingers[0].alarms.front().beside, std::vector<std::string>{"right"});
  EXPECT_LE(rig.fingers[0].alarms.front().warned, rig.fingers[0].alarms.front().noticed);
  EXPECT_GE(rig.fingers[0].alarms.front().warned, 60U);
  EXPECT_EQ(rig.fingers[0].state, FingerState::alarm);
  EXPECT_EQ(rig.fingers[1].state, FingerState::steady);
}

TEST(RigHealth, ReferenceExcludesPointsSinceTheAlarmBegan) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const RigHealth rig = softening(seed, -0.1, 60).judged();
    for (const HealthAlarm& alarm : rig.fingers[0].standing()) {
      const auto& reference = rig.fingers[0].references[static_cast<std::size_t>(alarm.number)];
      ASSERT_TRUE(reference);
      EXPECT_LE(reference->points, alarm.since) << "seed " << seed;
    }
  }
}

TEST(RigHealth, SharedChangeIsReportedForTheRigWithoutAlarms) {
  Rig rig;
  rig.becomes = [](const std::string&, HealthNumber number, int day) {
    return number == HealthNumber::pressure_loss && day >= 50 ? 1.0 : 0;
  };
  const RigHealth judged = rig.judged();
  const auto told = std::find_if(judged.shared.begin(), judged.shared.end(), [](const SharedChange& shared) {
    return shared.number == HealthNumber::pressure_loss;
  });
  ASSERT_NE(told, judged.shared.end());
  EXPECT_NEAR(told->change, 1, 0.1);
  EXPECT_EQ(told->since, day_text(50));
  EXPECT_TRUE(told->stands);
  EXPECT_EQ(told->fingers, (std::vector<std::string>{"left", "right"}));
  EXPECT_EQ(alarms_of(judged), 0U);
  EXPECT_NE(shared_sentence(*told).find("pressure loss while holding +"), std::string::npos);
  EXPECT_NE(shared_sentence(*told).find("not recorded"), std::string::npos);
  EXPECT_EQ(result::json_of(fields_of(*told))["number"], "pressure_loss_kpa");
  // The change that both fingers share ends with the repair.
  for (const SharedChange& shared : rig.judged({{day_text(60), "", "supply line"}}).shared)
    EXPECT_FALSE(shared.stands && shared.since == day_text(50));
}

TEST(RigHealth, FingerWithoutPeersRaisesAnAlarm) {
  Rig rig = softening(2, -0.2, 50);
  rig.names = {"left"};
  const RigHealth judged = rig.judged();
  ASSERT_EQ(judged.fingers.size(), 1U);
  ASSERT_FALSE(judged.fingers[0].alarms.empty());
  EXPECT_TRUE(judged.fingers[0].alarms.front().beside.empty());
  EXPECT_TRUE(judged.shared.empty());
}

TEST(RigHealth, AFingerInAlarmIsNoReferenceForItsPeers) {
  Rig rig;
  rig.weather_mm = 0;
  rig.becomes = [](const std::string& finger, HealthNumber number, int day) {
    if (number != HealthNumber::zero) return 0.0;
    if (finger == "left") return day >= 40 ? 0.5 : 0.0;
    return day >= 60 ? 0.5 : 0.0;
  };
  const RigHealth judged = rig.judged();
  for (const FingerHealth& finger : judged.fingers) {
    ASSERT_EQ(finger.alarms.size(), 1U) << finger.finger;
    EXPECT_NEAR(finger.alarms[0].change, 0.5, 0.05);
  }
  EXPECT_EQ(judged.fingers[0].alarms[0].since, 40U);
  EXPECT_EQ(judged.fingers[1].alarms[0].since, 60U);
}

TEST(RigHealth, MaintenanceRestartsThePeerDifferences) {
  Rig rig;
  rig.becomes = [](const std::string& finger, HealthNumber number, int day) {
    return finger == "right" && number == HealthNumber::zero && day >= 40 ? 1.0 : 0;
  };
  const RigHealth judged = rig.judged({{day_text(40), "right", "finger replaced"}});
  EXPECT_EQ(alarms_of(judged), 0U);
  EXPECT_TRUE(judged.fingers[0].unclear.empty());
}

TEST(RigHealth, ThreeFingersIdentifyTheChangedFinger) {
  Rig rig = softening(9, -0.1, 60);
  rig.names = {"left", "middle", "right"};
  const RigHealth judged = rig.judged();
  EXPECT_EQ(judged.fingers[0].state, FingerState::alarm);
  EXPECT_EQ(judged.fingers[1].state, FingerState::steady);
  EXPECT_EQ(judged.fingers[2].state, FingerState::steady);
}

TEST(RigHealth, GainReferenceIncludesTheTemperatureSlope) {
  Rig rig;
  rig.thermometer = true;
  const RigHealth judged = rig.judged();
  const auto& reference = judged.fingers[0].references[static_cast<std::size_t>(HealthNumber::gain)];
  ASSERT_TRUE(reference && reference->slope);
  EXPECT_NEAR(reference->slope->per_c, 0.06, 0.01);
  const auto json = result::json_of(fields_of(judged.fingers[0], {}));
  EXPECT_NEAR(json["numbers"]["gain_mm"]["per_c"].get<double>(), 0.06, 0.01);
  EXPECT_TRUE(json["numbers"]["zero_mm"]["per_c"].is_null());
  EXPECT_TRUE(json["temperature_c"].is_number());
  const std::string html = health_page(judged.fingers[0], {}, {"b", base, {}, judged.shared}).to_html();
  EXPECT_NE(html.find("mm per °C"), std::string::npos);
}

TEST(RigHealth, GainChangeAtEqualTemperatureIsNotThermal) {
  Rig rig = softening(3, -0.1, 60);
  const auto suspects = [](const RigHealth& judged) {
    std::vector<std::string> ids;
    for (const Suspect& suspect : suspicion_of(judged.fingers[0]).suspects) ids.push_back(suspect.id);
    return ids;
  };
  const auto blind = suspects(rig.judged());
  EXPECT_NE(std::find(blind.begin(), blind.end(), "thermal_gain"), blind.end());
  rig.thermometer = true;
  const RigHealth warm = rig.judged();
  ASSERT_FALSE(warm.fingers[0].standing().empty());
  const auto& reference = warm.fingers[0].references[static_cast<std::size_t>(HealthNumber::gain)];
  ASSERT_TRUE(reference && reference->slope);
  EXPECT_NEAR(reference->slope->per_c, 0.06, 0.01);
  const auto ids = suspects(warm);
  EXPECT_EQ(std::find(ids.begin(), ids.end(), "thermal_gain"), ids.end());
  EXPECT_FALSE(ids.empty());
}

TEST(RigHealth, ConcurrentSharedChangeIsUsedAsASymptom) {
  Rig rig = softening(3, -0.3, 60);
  const RigHealth judged = rig.judged();
  ASSERT_FALSE(judged.fingers[0].standing().empty());
  const std::string since = judged.fingers[0].points[judged.fingers[0].standing().back().since].label;
  SharedChange loss{HealthNumber::pressure_loss, 1, since, since, {"left", "right"}, false, true};
  EXPECT_EQ(suspicion_of(judged.fingers[0]).suspects.front().id, "ageing");
  EXPECT_EQ(suspicion_of(judged.fingers[0], {loss}).suspects.front().id, "leak");
  loss.since = "2026-12-01";  // the pressure loss begins later than the alarm
  EXPECT_EQ(suspicion_of(judged.fingers[0], {loss}).suspects.front().id, "ageing");
  EXPECT_TRUE(suspicion_of(judged.fingers[1], {loss}).suspects.empty());
}

TEST(RigHealth, PageStatesMissingTemperatureAndPeers) {
  Rig rig;
  rig.names = {"left"};
  const RigHealth judged = rig.judged();
  const std::string html = health_page(judged.fingers[0], {}, {"b", base, {}, {}}).to_html();
  EXPECT_NE(html.find("The temperature is not recorded"), std::string::npos);
  EXPECT_NE(html.find("contain no other healthy finger for a comparison"), std::string::npos);
}

TEST(RigHealth, UnattributedDifferenceIsReportedAsUnclear) {
  // The effect of the weather is much larger than the change of the finger. The values of a single finger
  // therefore do not show if this finger has changed.
  int unclear = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    Rig rig;
    rig.seed = seed;
    rig.weather_mm = 1.5;
    rig.becomes = [](const std::string& finger, HealthNumber number, int day) {
      return finger == "left" && number == HealthNumber::gain && day >= 60 ? -0.3 : 0;
    };
    const RigHealth judged = rig.judged();
    for (const FingerHealth& finger : judged.fingers) {
      EXPECT_TRUE(finger.alarms.empty() || finger.finger == "left");
      if (finger.unclear.empty()) continue;
      ++unclear;
      EXPECT_LE(finger.unclear[0].warned, finger.unclear[0].noticed);
      EXPECT_GE(finger.unclear[0].warned, 60U);
      EXPECT_NE(unclear_sentence(finger, finger.unclear[0]).find("do not yet show"), std::string::npos);
    }
  }
  EXPECT_GE(unclear, 30);
}

}  // namespace
}  // namespace softgrip::sysid::health::rig_health_test
