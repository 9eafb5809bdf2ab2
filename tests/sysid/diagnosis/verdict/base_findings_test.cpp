#include "sysid/diagnosis/verdict/base_findings.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/blocks/bouc_wen.h"
#include "model/blocks/kelvin_voigt.h"
#include "model/blocks/prandtl_ishlinskii.h"
#include "model/named.h"
#include "sysid/diagnosis/search/fit.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid {
namespace {

using model::SignalName;

/// The base structure without a valve.
model::Model published() {
  return model::only(loaded("bench_twin"),
                     [](const model::BlockInfo& info) { return info.station != model::Station::valve; });
}

/// Loops of plays that no Bouc-Wen element follows.
model::Model plays() {
  model::Model m = model::without_block(published(), model::block_type<model::BoucWen>());
  return model::with_block(std::move(m), {model::block_type<model::PrandtlIshlinskii>(),
                                          {0, 0.1, 1, 0.1, 6, 0.02, 15, 0.08, 25, 0.06}});
}

std::optional<BaseFindings> found_in(const model::Model& truth) {
  std::vector<Log> logs;
  for (const SignalName signal : {SignalName::tp1, SignalName::sp2})
    logs.push_back(simulated(truth, signal, 25, 0.03, 17));
  const SearchData data = make_search_data(make_records(logs, {}), published());
  const StructureFit recalibrated = fit_structure(data.records, {}, data.given);
  BaseQuestion question;
  question.noise_mm = 0.03;
  return find_base(data, recalibrated, recalibrated, question);
}

TEST(BaseFindings, LoopsOfAnotherFormAreNamed) {
  const auto found = found_in(plays());
  ASSERT_TRUE(found);
  const auto shape = std::find_if(found->named.begin(), found->named.end(),
                                  [](const NamedCause& n) { return n.cause.id == "hysteresis_shape"; });
  ASSERT_NE(shape, found->named.end()) << found->description;
  EXPECT_GE(shape->inclusion, 0.95);
  EXPECT_GT(shape->gain_mm2.lower, 0);
  EXPECT_LT(rmse_mm(found->losses), 0.5 * rmse_mm(found->recalibrated_losses));
}

TEST(BaseFindings, WhereTheGivenBaseHoldsThereIsNone) {
  EXPECT_FALSE(found_in(published()));
}

TEST(WinningShare, CountsTheDrawsThatLoseLess) {
  EXPECT_EQ(winning_share({1, 1, 1}, {2, 2, 2}, 1), 1);
  EXPECT_EQ(winning_share({2, 2, 2}, {1, 1, 1}, 1), 0);
  EXPECT_EQ(winning_share({1, 2, 3}, {1, 2, 3}, 1), 0.5);
  EXPECT_NEAR(winning_share({0, 1, 0, 1, 0, 1}, {1, 0, 1, 0, 1, 0}, 1), 0.5, 0.05);
}

}  // namespace
}  // namespace softgrip::sysid
