#include "sysid/diagnosis/verdict/mixed_intervals.h"

#include <gtest/gtest.h>

#include "model/named.h"
#include "sysid/diagnosis/verdict/naming.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::mixed_intervals_test {
namespace {

using model::SignalName;

constexpr double noise_mm = 0.04;
constexpr double true_delay_s = 0.130;

struct Named {
  std::vector<NamedCause> causes;
  Interval alone;  ///< interval of the delay from a fit of a model without the lag
  std::vector<std::string> sentences;
};

/// Returns a diagnosis that names the delay but not the lag. The logs were simulated with the model
/// bench_twin, the delay and the lag.
Named delay_of(SignalName signal, const model::Model& twin) {
  const model::Model without_valve =
      model::only(twin, [](const model::BlockInfo& info) { return info.station != model::Station::valve; });
  const SearchData data =
      make_search_data(make_records({simulated(twin, signal, 50, noise_mm, 2)}, {}), without_valve);
  const Division division = divide(data.records, 8);
  const Cause delay = *find_cause("transport_delay");
  const StructureFit base = fit_structure(data.records, {}, data.given);
  Selection selection;
  selection.extended = *fit_candidates(data, base, {.only = {delay}}).front().fit;
  selection.extended_losses = held_out_losses(data.records, division, selection.extended);
  selection.undecided = fit_confounded(data, selection.extended, division);
  selection.chosen.push_back({delay, {}, {}, {}, {}, 1});
  Named named{name_chosen(data.records, selection.extended, selection.chosen), {}, {}};
  if (named.causes.empty()) return named;
  named.alone = named.causes.front().parameters.front().ci95;
  named.sentences = mix_intervals(named.causes, data.records, selection, 1);
  return named;
}

TEST(MixedIntervals, HoldTheDelayWhereALagIsInQuestion) {
  const Named named = delay_of(SignalName::tp2, loaded("bench_twin"));
  ASSERT_EQ(named.causes.size(), 1U);
  ASSERT_EQ(named.causes.front().cause.id, "transport_delay");
  EXPECT_GT(named.alone.lower, true_delay_s) << "without a lag in the model, the delay includes the lag";
  const Interval mixed = named.causes.front().parameters.front().ci95;
  EXPECT_LT(mixed.lower, true_delay_s);
  EXPECT_GT(mixed.upper, true_delay_s);
  ASSERT_EQ(named.sentences.size(), 1U);
  EXPECT_EQ(named.sentences.front(),
            "these logs do not determine whether valve_lag is present in addition to transport_delay, so the "
            "intervals cover both cases");
}

}  // namespace
}  // namespace softgrip::sysid::mixed_intervals_test
