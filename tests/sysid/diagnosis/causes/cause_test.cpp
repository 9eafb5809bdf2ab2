// Tests properties that every cause in the registry must have.

#include "sysid/diagnosis/causes/cause.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "model/catalogue.h"
#include "sysid/diagnosis/causes/registry.h"
#include "tests/model/presets.h"
#include "tests/sysid/diagnosis/campaign.h"

namespace softgrip::sysid::cause_test {
namespace {

Scales typical_scales() {
  Scales s = scales_of(known_campaign(3));
  s.largest_supply_kpa = 500;
  s.has_supply = s.has_temperature = true;
  s.residual_lines = {{1.5, 0.1, 0.1}, {4.0, 0.02, -0.1}};
  return s;
}

/// Returns bench_twin without its valve blocks, with the given block added.
model::Model with(const model::BlockSpec& block) {
  const model::Model twin = model::testing::preset("bench_twin");
  return model::with_block(
      model::only(twin, [](const model::BlockInfo& info) { return info.station != model::Station::valve; }),
      block);
}

template <class... C>
constexpr std::size_t size_of(List<C...>) {
  return sizeof...(C);
}

TEST(CauseList, RegisteredCausesAreFoundById) {
  EXPECT_EQ(all_causes().size(), size_of(causes::All{}));
  for (const Cause& cause : all_causes()) EXPECT_EQ(find_cause(cause.id)->id, cause.id);
  EXPECT_FALSE(find_cause("no_such_cause").has_value());
}

TEST(CauseStarts, OfASlowProcessAreProportionalToItsTimeUnit) {
  Scales finger = typical_scales(), process = finger;
  ASSERT_EQ(finger.time_unit_s, 1);
  process.time_unit_s = 60;
  for (const char* id : {"transport_delay", "valve_lag", "sensor_lag", "clock_offset", "inertia"}) {
    const CauseForm& form = find_cause(id)->forms.front();
    const std::vector<model::BlockSpec> quick = form.starts(finger), slow = form.starts(process);
    ASSERT_EQ(quick.size(), slow.size()) << id;
    for (std::size_t i = 0; i < quick.size(); ++i)
      EXPECT_DOUBLE_EQ(slow[i].values.front(), 60 * quick[i].values.front()) << id;
  }
}

class Causes : public ::testing::TestWithParam<Cause> {
 protected:
  const Cause& cause = GetParam();
  const Scales scales = typical_scales();

  /// Calls check(form, start) for every form of the cause and for every start point of the form.
  template <class Check>
  void each_start(Check check) {
    for (const CauseForm& form : cause.forms) {
      if (form.starts == nullptr) continue;
      for (const model::BlockSpec& start : form.starts(scales)) check(form, start);
    }
  }
};

TEST_P(Causes, HaveStartsInEveryForm) {
  for (const CauseForm& form : cause.forms) {
    ASSERT_EQ(form.starts != nullptr, cause.found_by_fitting);
    if (form.starts != nullptr) {
      EXPECT_FALSE(form.starts(scales).empty());
    }
  }
}

TEST_P(Causes, StartAsValidModelsOfTheirForm) {
  each_start([&](const CauseForm& form, const model::BlockSpec& start) {
    EXPECT_EQ(start.type, form.type);
    EXPECT_EQ(&form_of(cause, start), &form) << "the start point belongs to another block form of the cause";
    const auto wrong = model::validate(with(start));
    ASSERT_TRUE(wrong.empty()) << wrong.front();
  });
}

TEST_P(Causes, StartValuesLieWithinTheFitRange) {
  each_start([&](const CauseForm& form, const model::BlockSpec& start) {
    bool moves = false;
    for (std::size_t i = 0; i < start.values.size(); ++i) {
      if (!form.is_fitted(i)) continue;
      moves = true;
      const model::ParameterSpec& spec = model::catalogue()[form.type].spec(i);
      const Range range = form.range(i, scales, with(start));
      EXPECT_LT(range.lower, range.upper) << spec.name;
      EXPECT_LT(std::max(range.lower, spec.lower), std::min(range.upper, spec.upper)) << spec.name;
      EXPECT_GE(start.values[i], range.lower) << spec.name;
      EXPECT_LE(start.values[i], range.upper) << spec.name;
    }
    EXPECT_TRUE(moves);
  });
}

// A form with more than three free parameters can fit almost any curve. The cause must therefore declare it
// as a free form.
TEST_P(Causes, FitAtMostThreeParametersUnlessFreeForm) {
  each_start([&](const CauseForm& form, const model::BlockSpec& start) {
    std::size_t fitted = 0;
    for (std::size_t i = 0; i < start.values.size(); ++i)
      fitted += form.is_fitted(i) && !model::catalogue()[form.type].spec(i).whole ? 1U : 0U;
    EXPECT_GE(fitted, 1U);
    if (!form.free_form) {
      EXPECT_LE(fitted, 3U);
    }
  });
}

TEST_P(Causes, AreFoundInAndRemovedFromAModel) {
  each_start([&](const CauseForm&, const model::BlockSpec& start) {
    const model::Model model = with(start);
    const auto at = position_of(model, cause);
    ASSERT_TRUE(at);
    EXPECT_EQ(model.blocks[*at], start);
    EXPECT_EQ(form_among(all_causes(), start), &form_of(cause, start));
    EXPECT_FALSE(position_of(without(model, cause), cause));
  });
}

TEST_P(Causes, ReportTheRequiredColumnIfMissing) {
  EXPECT_EQ(unanswerable(cause, scales), "");
  Scales bare = scales;
  bare.has_supply = bare.has_temperature = false;
  EXPECT_EQ(unanswerable(cause, bare).empty(), cause.needs == Column::none);
  if (cause.needs != Column::none) {
    EXPECT_NE(unanswerable(cause, bare).find(name_of(cause.needs)), std::string::npos);
  }
  Scales driven = scales;
  driven.has_valve = false;
  EXPECT_EQ(unanswerable(cause, driven).empty(), cause.station != model::Station::valve);
}

// Two causes may be declared as indistinguishable, or as distinguishable by a gauge check only. In both
// cases, one cause must be a cause of the sensor, and the other one must not.
TEST_P(Causes, ExactlyOneOfTwoCounterpartsIsASensorCause) {
  const auto at_sensor = [](const Cause& c) { return c.station == model::Station::sensor; };
  for (const Cause& other : sensor_counterparts(cause))
    EXPECT_NE(at_sensor(cause), at_sensor(other)) << other.id;
  if (cause.indistinguishable.empty()) return;
  EXPECT_EQ(find_cause(cause.indistinguishable)->indistinguishable, cause.id);
  EXPECT_NE(std::find(cause.counterparts.begin(), cause.counterparts.end(), cause.indistinguishable),
            cause.counterparts.end());
}

TEST_P(Causes, OnlyStaticSensorCausesAreVisibleToAGauge) {
  for (const CauseForm& form : cause.forms) EXPECT_EQ(form.shown_mm != nullptr, cause.is_static_sensor());
  if (cause.is_static_sensor()) {
    EXPECT_EQ(cause.station, model::Station::sensor);
  }
}

INSTANTIATE_TEST_SUITE_P(Registry, Causes, ::testing::ValuesIn(all_causes().begin(), all_causes().end()),
                         [](const auto& each) { return std::string(each.param.id); });

TEST(Registry, CoversTheCatalogue) {
  std::set<std::string_view> none;
  for (std::size_t type = 0; type < model::catalogue().size(); ++type) {
    if (cause_of(type) == nullptr) none.insert(model::catalogue()[type].info.id);
  }
  EXPECT_EQ(none,
            (std::set<std::string_view>{"asymmetric_valve_lag", "bouc_wen", "chamber_lag", "characteristic",
                                        "kelvin_voigt", "linear_modes", "pressure_dependent_creep",
                                        "pressure_regulator", "quantisation", "rate_limit", "sensor_noise"}));
  EXPECT_FALSE(find_cause("bouc_wen"));
  EXPECT_FALSE(find_cause("no such thing"));
  EXPECT_TRUE(std::is_sorted(all_causes().begin(), all_causes().end(), [](const Cause& a, const Cause& b) {
    return a.forms.front().type < b.forms.front().type;
  }));
}

// For some parameter values, the block of a cause would describe a different cause. The bounds of the fit
// must exclude these values.
TEST(Ranges, ExcludeValuesThatDescribeAnotherCause) {
  const Scales scales = typical_scales();
  const auto range = [&](std::string_view id, std::string_view parameter) {
    const Cause cause = *find_cause(id);
    for (const model::BlockSpec& start : starts_of(cause, scales)) {
      const auto index = model::find_parameter(start, parameter);
      const CauseForm& form = form_of(cause, start);
      if (index && form.is_fitted(*index)) return form.range(*index, scales, with(start));
    }
    return Range{NAN, NAN};
  };
  EXPECT_LE(range("rate_dependent_hysteresis", "width_kpa").upper, scales.largest_kpa);
  EXPECT_LE(range("inertia", "damping_ratio").upper, std::sqrt(0.5));
  EXPECT_GE(range("contact", "position_mm").lower, 0.01 * scales.span_mm);
  // The slowest creep branch of bench_twin has a time constant of 16.5 s. The time constant of the cause
  // "slow creep" must be larger.
  EXPECT_GE(range("slow_creep", "time_constant_s").lower, 16.0);
  EXPECT_GT(scales.campaign_s, 0);
  EXPECT_DOUBLE_EQ(range("periodic_disturbance", "frequency_hz").lower, 10 / scales.campaign_s);
}

}  // namespace
}  // namespace softgrip::sysid::cause_test
