#include "sysid/fitting/held_out.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sysid/fitting/trajectory.h"
#include "tests/sysid/simulated.h"

namespace softgrip::sysid::held_out_test {
namespace {

using model::SignalName;

struct Predicted {
  model::Model twin = loaded("bench_twin");
  std::vector<Record> records = make_records(
      {simulated(twin, SignalName::tp1, 50, 0.05, 1), simulated(twin, SignalName::steps, 50, 0.05, 2)}, {});
  FitPoint point{twin, rest_starts(twin, records)};

  /// Sets the readings to the prediction of the model. The start states have the offset `off_mm`.
  explicit Predicted(double off_mm) {
    for (std::size_t r = 0; r < records.size(); ++r) {
      records[r].reading_mm = predict(twin, records[r], point.starts[r]);
      point.starts[r].offset_mm = off_mm;
    }
  }
};

TEST(HeldOutLosses, OneMillimetreErrorGivesALossOfOneInEveryBlock) {
  const Predicted off(1);
  for (const Division& division :
       {divide(off.records, 8), divide_into_fifths(off.records), divide_into_halves(off.records)}) {
    const BlockLosses losses =
        held_out_losses(off.records, division, [&](const std::vector<Record>&) { return off.point; });
    ASSERT_EQ(losses.size(), division.blocks.size());
    for (const double loss : losses) EXPECT_NEAR(loss, 1, 1e-9);
    EXPECT_NEAR(rmse_mm(losses), 1, 1e-9);
  }
}

TEST(HeldOutLosses, ComeFromAFitWithoutTheBlock) {
  const Predicted exact(0);
  const Division division = divide_into_fifths(exact.records);
  // This function replaces the fit. It counts the readings of the last block of the second log and returns
  // this number as the offset. If the block is hidden, the number is 0.
  const Block last = division.blocks.back();
  const BlockLosses losses = held_out_losses(exact.records, division, [&](const std::vector<Record>& rest) {
    double seen = 0;
    for (std::size_t i = last.first; i < last.last; ++i)
      seen += std::isfinite(rest[last.record].reading_mm[i]) ? 1 : 0;
    FitPoint point = exact.point;
    point.starts[last.record].offset_mm = seen;
    return point;
  });
  EXPECT_NEAR(losses.back(), 0, 1e-18);
}

TEST(HeldOutLosses, EqualTheSquaredSpanForALargeError) {
  const Predicted far(1e6);
  const Division division = divide(far.records, 8);
  const BlockLosses losses =
      held_out_losses(far.records, division, [&](const std::vector<Record>&) { return far.point; });
  for (std::size_t b = 0; b < losses.size(); ++b) {
    const double span_mm = far.records[division.blocks[b].record].span_mm;
    EXPECT_EQ(losses[b], span_mm * span_mm);
  }
}

}  // namespace
}  // namespace softgrip::sysid::held_out_test
