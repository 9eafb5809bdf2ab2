#include "sysid/fitting/fit_space.h"

#include <string>

#include <gtest/gtest.h>

#include "model/blocks/prandtl_ishlinskii.h"
#include "model/named.h"

namespace softgrip::sysid::fit_space_test {
namespace {

/// The parameters of a nonlinear envelope are fitted again if a cause is added. Linear envelopes have no
/// parameters to fit.
TEST(IsMovable, OfTheEnvelopesWhereTheyAreBentAlone) {
  for (const double end_kpa : {0.0, 50.0}) {
    const model::Model plays = model::with_block(
        {}, {model::block_type<model::PrandtlIshlinskii>(), {10, 0, 0, end_kpa, 0, 0.2, 5, 0.1}});
    const auto moves = [&](const char* name) {
      return is_movable(plays, model::find_path(plays, std::string("prandtl_ishlinskii.") + name).value());
    };
    EXPECT_EQ(moves("envelope_bend"), end_kpa > 0);
    EXPECT_EQ(moves("envelope_skew"), end_kpa > 0);
    EXPECT_TRUE(moves("w2_mm_per_kpa"));
    for (const char* placed : {"trained_kpa", "envelope_kpa", "r2_kpa"})
      EXPECT_FALSE(moves(placed)) << placed;
  }
}

}  // namespace
}  // namespace softgrip::sysid::fit_space_test
