#include "sysid/fitting/minimise.h"

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include <gtest/gtest.h>

#include "tests/sysid/simulated.h"

namespace softgrip::sysid::minimise_test {
namespace {

using Values = std::vector<double>;

/// Residuals of two coordinates, which the test states as functions of u. The bounds of u are -2 and 2 in
/// both coordinates. The model and its parameters have no effect.
class Stated final : public Residuals {
 public:
  using Function = std::function<Values(const Values& u)>;
  /// @param slopes  derivatives of the residuals with respect to u, row by row.
  Stated(const std::vector<Record>& records, const FitSpace& space, Function residuals, Function slopes)
      : Residuals(records, space), residuals_(std::move(residuals)), slopes_(std::move(slopes)) {}

  bool evaluate(std::span<const double> z, std::span<double> r, std::span<double> jacobian) const override {
    ++(jacobian.empty() ? trials : derivatives);
    const Values u{at(z, 0), at(z, 1)};
    const Values values = residuals_(u);
    if (std::isnan(values[0])) return false;
    if (!r.empty()) std::copy(values.begin(), values.end(), r.begin());
    if (jacobian.empty()) return true;
    const Values slopes = slopes_(u);
    for (std::size_t i = 0; i < slopes.size(); ++i) jacobian[i] = slopes[i] / width(i % 2);
    return true;
  }
  [[nodiscard]] double at(std::span<const double> z, std::size_t i) const {
    return (z[i] - centre(i)) / width(i);
  }
  [[nodiscard]] Values z(const Values& u) const {
    return {centre(0) + u[0] * width(0), centre(1) + u[1] * width(1)};
  }

  mutable int trials = 0, derivatives = 0;

 private:
  [[nodiscard]] double centre(std::size_t i) const {
    return (space().free()[i].lower_z() + space().free()[i].upper_z()) / 2;
  }
  [[nodiscard]] double width(std::size_t i) const {
    return (space().free()[i].upper_z() - space().free()[i].lower_z()) / 4;
  }

  Function residuals_, slopes_;
};

MinimiseOptions limited_to(int most_iterations) {
  MinimiseOptions options;
  options.most_iterations = most_iterations;
  return options;
}

class Minimise : public testing::Test {
 protected:
  /// Returns residuals for `count` readings.
  Stated stated(std::size_t count, Stated::Function residuals, Stated::Function slopes) {
    Record record;
    for (std::size_t i = 0; i < count; ++i) record.time_s.push_back(0.01 * static_cast<double>(i));
    record.drive_kpa.assign(count, 1);
    record.reading_mm.assign(count, 1);
    record.readings = count;
    record.finest_interval_s = 0.01;
    records_ = {record};
    const model::Model model = loaded("zhang2025");
    return {records_, FitSpace(model, records_, {1, 2}), std::move(residuals), std::move(slopes)};
  }
  /// Rosenbrock's valley with the minimum 0 at u = (1, 1).
  Stated valley() {
    return stated(
        2,
        [](const Values& u) {
          return Values{10 * (u[1] - u[0] * u[0]), 1 - u[0]};
        },
        [](const Values& u) {
          return Values{-20 * u[0], 10, -1, 0};
        });
  }

  std::vector<Record> records_;
};

TEST_F(Minimise, FindsTheMinimumOfRosenbrocksValley) {
  const Stated problem = valley();
  const Minimum minimum = minimise(problem, problem.z({-1.2, 1}), limited_to(200));
  EXPECT_TRUE(minimum.converged);
  EXPECT_NEAR(problem.at(minimum.z, 0), 1, 1e-6);
  EXPECT_NEAR(problem.at(minimum.z, 1), 1, 1e-6);
  EXPECT_NEAR(minimum.rmse_mm, std::sqrt(minimum.cost), 1e-12);
}

/// The minimum of the unbounded problem is outside of the bound of u[1]. The columns are nearly parallel, so
/// a step that is only clipped at the bound would reduce the error very slowly.
TEST_F(Minimise, ABoundDoesNotSlowDownTheOtherCoordinates) {
  const Stated problem = stated(
      3,
      [](const Values& u) {
        return Values{u[0] + u[1] - 3, u[0] + 1.1 * u[1] - 4, 0.1};
      },
      [](const Values&) { return Values{1, 1, 1, 1.1, 0, 0}; });
  const Minimum minimum = minimise(problem, problem.z({0, 0}));
  EXPECT_TRUE(minimum.converged);
  EXPECT_EQ(problem.at(minimum.z, 1), 2);
  EXPECT_NEAR(problem.at(minimum.z, 0), 1.4, 1e-6);  // mean of 3 - 2 and 4 - 2.2
  EXPECT_LE(problem.derivatives, 8);
}

TEST_F(Minimise, TheHeldCoordinateStays) {
  const Stated problem = valley();
  const Values start = problem.z({0.5, 1});
  MinimiseOptions options;
  options.held = 0;
  const Minimum minimum = minimise(problem, start, options);
  EXPECT_TRUE(minimum.converged);
  EXPECT_EQ(minimum.z[0], start[0]);
  EXPECT_NEAR(problem.at(minimum.z, 1), 0.25, 1e-6);
}

TEST_F(Minimise, TheStartIsClippedToTheBounds) {
  const Stated problem = valley();
  const Minimum minimum = minimise(problem, problem.z({5, 5}), limited_to(0));
  EXPECT_EQ(problem.at(minimum.z, 0), 2);
  EXPECT_EQ(problem.at(minimum.z, 1), 2);
  EXPECT_FALSE(minimum.converged);
}

TEST_F(Minimise, StaysWhereTheResidualsAreDefined) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Stated problem = stated(
      2,
      [&](const Values& u) {
        return u[0] > 0.5 ? Values{nan, nan} : Values{u[0] - 0.4, u[1] - 1};
      },
      [](const Values&) {
        return Values{1, 0, 0, 1};
      });
  const Minimum minimum = minimise(problem, problem.z({-2, -2}));
  EXPECT_NEAR(problem.at(minimum.z, 0), 0.4, 1e-6);
  const Minimum nowhere = minimise(problem, problem.z({1, 1}));
  EXPECT_FALSE(nowhere.converged);
  EXPECT_TRUE(std::isinf(nowhere.cost));
}

/// One of 9 readings is wrong by 1. With Huber's loss, the mean moves by at most the width times 1/8.
TEST_F(Minimise, HubersLossLimitsTheEffectOfAnOutlier) {
  const auto residuals = [](const Values& u) {
    Values r(10, u[0]);
    r[3] -= 1;
    r[9] = u[1];
    return r;
  };
  const auto slopes = [](const Values&) {
    Values s;
    for (int i = 0; i < 9; ++i) s.insert(s.end(), {1, 0});
    s.insert(s.end(), {0, 1});
    return s;
  };
  const Stated problem = stated(10, residuals, slopes);
  EXPECT_NEAR(problem.at(minimise(problem, problem.z({1, 1})).z, 0), 1.0 / 9, 1e-6);
  MinimiseOptions options;
  options.huber_mm = 0.01;
  const Minimum robust = minimise(problem, problem.z({1, 0}), options);
  EXPECT_NEAR(problem.at(robust.z, 0), 0.01 / 8, 1e-6);
  // The RMSE contains the outlier without Huber's loss.
  EXPECT_NEAR(robust.rmse_mm, std::sqrt(0.1), 0.001);
}

/// Trials that do not reduce the error count too, so the number of simulations is limited.
TEST_F(Minimise, LimitsTheNumberOfTrials) {
  const Stated problem = valley();
  const Minimum minimum = minimise(problem, problem.z({-1.2, 1}), limited_to(5));
  EXPECT_FALSE(minimum.converged);
  EXPECT_LE(minimum.iterations, 5);
  EXPECT_EQ(problem.trials, 6);  // the start point and 5 trials
}

TEST(MinimisePlain, FitsADecayToExactReadings) {
  const auto residuals = [](std::span<const double> p, std::span<double> r) {
    for (std::size_t i = 0; i < r.size(); ++i) {
      const double t = 0.1 * static_cast<double>(i);
      r[i] = p[0] * std::exp(-p[1] * t) - 3 * std::exp(-0.7 * t);
    }
  };
  const PlainMinimum minimum = minimise_plain(residuals, 30, {1, 2});
  EXPECT_NEAR(minimum.p[0], 3, 1e-6);
  EXPECT_NEAR(minimum.p[1], 0.7, 1e-6);
  EXPECT_LT(minimum.sum_of_squares, 1e-12);
}

TEST(MinimisePlain, WithoutParametersTheErrorIsComputed) {
  const auto residuals = [](std::span<const double>, std::span<double> r) {
    std::fill(r.begin(), r.end(), 2);
  };
  const PlainMinimum minimum = minimise_plain(residuals, 5, {});
  EXPECT_TRUE(minimum.p.empty());
  EXPECT_EQ(minimum.sum_of_squares, 20);
}

}  // namespace
}  // namespace softgrip::sysid::minimise_test
