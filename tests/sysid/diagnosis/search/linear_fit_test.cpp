#include "sysid/diagnosis/search/linear_selection.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "model/catalogue.h"
#include "sysid/fitting/start_estimate.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::linear_fit_test {
namespace {

constexpr double noise_mm = 0.04;

TEST(LinearFit, FitsTheCauseAndKeepsTheBaseStructure) {
  const model::Model base = loaded("zhang2025");
  const Cause cause = *find_cause("backlash");
  const auto with_gap = [&](double gap_mm) {
    return model::with_block(base, {cause.forms.front().type, {gap_mm}});
  };
  const std::vector<Record> records =
      make_records({simulated(with_gap(1.2), model::SignalName::tp1, 40, noise_mm, 1)}, {});
  const Scan scan(records, {}, {base, rest_starts(base, records)});
  ASSERT_TRUE(scan.usable());
  const model::Model start = with_gap(0.7);
  const LinearFit fit = linear_fit_from(records, scan, cause, {start, rest_starts(start, records)});
  EXPECT_NEAR(std::sqrt(fit.mean_square_mm2), noise_mm, 0.1 * noise_mm);
  const model::Model& fitted = fit.beside.model;
  EXPECT_NEAR(fitted.blocks[*position_of(fitted, cause)].values[0], 1.2, 0.12);
  EXPECT_EQ(fitted.blocks[0].values, base.blocks[0].values);
}

}  // namespace
}  // namespace softgrip::sysid::linear_fit_test
