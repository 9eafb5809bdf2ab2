#include "control/sequences/planner.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "model/chain.h"

namespace softgrip::control {
namespace {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;

/// Shortest time between two points of a plan [s].
constexpr double finest_step_s = 0.025;
/// Duration of the part of a window whose commands are kept, and of the preview after this part [s]. The best
/// present command depends on the reference at a later time. This dependence decays with exp(-z t) over the
/// time difference t, where z is the zero of the inverse response: 7/s for the published model.
constexpr double decided_s = 4;
constexpr double ahead_s = 1.5;
/// Weight of the second difference of the command [mm/kPa]. The weight changes a plan by much less than the
/// required accuracy.
constexpr double smooth_mm_per_kpa = 1e-3;
/// Weight of the part of a command that is outside its bounds [mm/kPa].
constexpr double bound_mm_per_kpa = 30;
/// Pressure difference for the numerical derivatives of the chain [kPa].
constexpr double aside_kpa = 1e-6;
/// Largest number of iterations of one search, and of all searches in one window together. Both numbers limit
/// the computing time.
constexpr int most_iterations = 25;
constexpr int most_iterations_of_window = 60;
/// If the root mean square error of a window is below this value, the search is not repeated from other
/// initial guesses.
constexpr double good_mm = 0.01;
/// The search in a window ends when an iteration reduces the cost by less than this share.
constexpr double done_share = 2e-3;

/// One window of a plan: the state of the chain at the start of the window, the commands before the window,
/// and the target displacements.
class Window {
 public:
  Window(const model::Chain<double>& begin, std::array<double, 2> before_kpa, Vector wanted_mm,
         const LimitSettings& limits, double step_s)
      : begin_(begin),
        before_kpa_(before_kpa),
        wanted_mm_(std::move(wanted_mm)),
        limits_(limits),
        step_s_(step_s),
        rise_kpa_(limits.slew_up_kpa_per_s * step_s),
        fall_kpa_(limits.slew_down_kpa_per_s * step_s) {}

  /// Returns the command with the lowest cost that the search finds from the initial guess `u`.
  Vector solve(Vector u) {
    double cost = cost_of(u);
    double damping = 1e-4;
    for (int i = 0; i < most_iterations && iterations_left_ > 0; ++i, --iterations_left_) {
      linearise(u);
      bool better = false;
      double last = cost;
      for (int attempt = 0; attempt < 12 && !better; ++attempt) {
        damped_ = normal_;
        damped_.diagonal().array() += damping;
        factors_.compute(damped_);
        const Vector next = u - factors_.solve(gradient_);
        const double at_next = cost_of(next);
        better = at_next < cost;
        if (better) {
          u = next;
          last = cost;
          cost = at_next;
          damping = std::max(1e-7, damping / 10);
        } else {
          damping *= 10;
        }
      }
      // Strong damping makes the step of an iteration short. Therefore, a small improvement under strong
      // damping does not mean that the search has converged.
      if (!better || (cost > (1 - done_share) * last && damping < 1e-3)) break;
    }
    return u;
  }

  /// Returns the number of iterations of all searches. The last iteration of a search that ends before its
  /// largest number of iterations is not counted.
  [[nodiscard]] int iterations() const noexcept { return most_iterations_of_window - iterations_left_; }

  /// Returns the factor by which the commands `u` must be scaled so that their response fits the target.
  /// Within a window, the gain of a finger with slow creep is much smaller than its settled gain.
  [[nodiscard]] double share_needed(const Vector& u) const {
    model::Chain<double> chain = begin_;
    double reached_wanted = 0, reached_reached = 0;
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      chain.step(step_s_, u[i]);
      const double reached_mm = chain.after(model::Station::load);
      reached_wanted += reached_mm * wanted_mm_[i];
      reached_reached += reached_mm * reached_mm;
    }
    return reached_wanted > 0 ? reached_wanted / reached_reached : 1;
  }

  [[nodiscard]] double cost_of(const Vector& u) const {
    model::Chain<double> chain = begin_;
    double cost = 0;
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      chain.step(step_s_, u[i]);
      const double miss = chain.after(model::Station::load) - wanted_mm_[i];
      const double bend = smooth_mm_per_kpa * (u[i] - 2 * before(u, i - 1) + before(u, i - 2));
      const double out = bound_mm_per_kpa * outside(u[i]);
      const double fast = bound_mm_per_kpa * too_fast(u[i] - before(u, i - 1));
      cost += miss * miss + bend * bend + out * out + fast * fast;
    }
    return cost;
  }

 private:
  [[nodiscard]] double before(const Vector& u, Eigen::Index i) const {
    return i >= 0 ? u[i] : before_kpa_[static_cast<std::size_t>(-1 - i)];
  }

  /// Returns by how much a command is outside the pressure range [kPa]. The result is negative below the
  /// range, and 0 inside.
  [[nodiscard]] double outside(double u) const {
    return std::max(0.0, u - limits_.pressure_max_kpa) + std::min(0.0, u - limits_.pressure_min_kpa);
  }
  [[nodiscard]] double too_fast(double change) const {
    return std::max(0.0, change - rise_kpa_) + std::min(0.0, change + fall_kpa_);
  }

  /// Computes the normal equations at the command `u`.
  void linearise(const Vector& u) {
    const Eigen::Index n = u.size();
    jacobian_.setZero(n, n);
    Vector miss(n);
    model::Chain<double> chain = begin_;
    std::vector<model::Chain<double>> states;
    states.reserve(static_cast<std::size_t>(n));
    for (Eigen::Index i = 0; i < n; ++i) {
      states.push_back(chain);
      chain.step(step_s_, u[i]);
      miss[i] = chain.after(model::Station::load) - wanted_mm_[i];
    }
    // In this loop, column j is the derivative with respect to an equal change of point j and of all later
    // points. A change of point j alone would cause a small hysteresis loop. After the loop, each column is
    // reduced by the next column. The result is the derivative with respect to point j alone.
    for (Eigen::Index j = 0; j < n; ++j) {
      model::Chain<double>& other = states[static_cast<std::size_t>(j)];
      const double aside = std::copysign(aside_kpa, u[j] - before(u, j - 1));
      for (Eigen::Index i = j; i < n; ++i) {
        other.step(step_s_, u[i] + aside);
        jacobian_(i, j) = (other.after(model::Station::load) - wanted_mm_[i] - miss[i]) / aside;
      }
    }
    for (Eigen::Index j = 0; j + 1 < n; ++j) jacobian_.col(j) -= jacobian_.col(j + 1);
    normal_.setZero(n, n);
    normal_.selfadjointView<Eigen::Lower>().rankUpdate(jacobian_.transpose());
    gradient_.noalias() = jacobian_.transpose() * miss;
    add_rows(u);
  }

  /// Adds the terms for the smoothness and for the bounds of the command to the normal equations.
  void add_rows(const Vector& u) {
    constexpr double smooth = smooth_mm_per_kpa * smooth_mm_per_kpa;
    constexpr double bound = bound_mm_per_kpa * bound_mm_per_kpa;
    constexpr std::array<double, 3> bend{1, -2, 1};
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      const double bent = u[i] - 2 * before(u, i - 1) + before(u, i - 2);
      for (Eigen::Index a = 0; a < 3 && i - a >= 0; ++a) {
        const auto at = static_cast<std::size_t>(a);
        gradient_[i - a] += smooth * bend[at] * bent;
        for (Eigen::Index b = a; b < 3 && i - b >= 0; ++b) {
          normal_(i - a, i - b) += smooth * bend[at] * bend[static_cast<std::size_t>(b)];
        }
      }
      if (const double out = outside(u[i]); out != 0) {
        gradient_[i] += bound * out;
        normal_(i, i) += bound;
      }
      if (const double fast = too_fast(u[i] - before(u, i - 1)); fast != 0) {
        gradient_[i] += bound * fast;
        normal_(i, i) += bound;
        if (i > 0) {
          gradient_[i - 1] -= bound * fast;
          normal_(i - 1, i - 1) += bound;
          normal_(i, i - 1) -= bound;
        }
      }
    }
  }

  const model::Chain<double>& begin_;
  std::array<double, 2> before_kpa_;  ///< last two commands before the window, newest first
  Vector wanted_mm_;
  const LimitSettings& limits_;
  double step_s_;
  double rise_kpa_;
  double fall_kpa_;
  int iterations_left_ = most_iterations_of_window;
  // The matrices keep their memory between iterations, because the system clears newly allocated memory.
  Matrix jacobian_, normal_, damped_;
  Vector gradient_;
  Eigen::LDLT<Matrix, Eigen::Lower> factors_;
};

/// Searches from several initial guesses until the error of a command is below good_mm, and returns the
/// command with the lowest cost. Several guesses are needed, because the slope of the hysteresis jumps where
/// the command reverses, and a search may stop at such a jump.
Vector best_of(Window& window, const Vector& guess, const Vector& proportional) {
  Vector best = window.solve(guess);
  double least = window.cost_of(best);
  const double good = good_mm * good_mm * static_cast<double>(best.size());
  for (const double share : {1.0, window.share_needed(proportional), 0.8, 1.2}) {
    if (least <= good) break;
    Vector u = window.solve(share * proportional);
    const double cost = window.cost_of(u);
    if (cost < least) {
      least = cost;
      best = std::move(u);
    }
  }
  return best;
}

}  // namespace

Planner::Planner(const model::Model& model, const LimitSettings& limits, double tick_s)
    : model_(without_dead_time(model)),
      limits_(limits),
      step_s_(std::max(tick_s, finest_step_s)),
      settled_(settled_line(model, limits)) {}

double Planner::command_kpa() const noexcept {
  return past_kpa_.empty() ? resting_kpa(limits_) : past_kpa_.back();
}

model::Chain<double> Planner::finger() const {
  model::Chain<double> chain(model_, {}, step_s_);
  chain.reset(resting_kpa(limits_));
  for (const double pressure : past_kpa_) chain.step(step_s_, pressure);
  return chain;
}

double Planner::displacement_mm() const {
  return finger().after(model::Station::load);
}

void Planner::drive(const std::function<double(double time_s)>& command_kpa, double duration_s) {
  const auto points = static_cast<std::size_t>(std::lround(std::max(0.0, duration_s) / step_s_));
  for (std::size_t i = 1; i <= points; ++i) {
    const double wanted = command_kpa(static_cast<double>(i) * step_s_);
    past_kpa_.push_back(limit(limits_, wanted, this->command_kpa(), step_s_).command_kpa);
  }
}

/// Adds a point to the plan: the command after the limits, and the model's response to this command.
void Planner::add_point(double wanted_kpa, model::Chain<double>& chain, PressurePlan& plan) {
  const double command = limit(limits_, wanted_kpa, command_kpa(), step_s_).command_kpa;
  chain.step(step_s_, command);
  past_kpa_.push_back(command);
  plan.pressure_kpa.push_back(command);
  plan.displacement_mm.push_back(chain.after(model::Station::load));
}

PressurePlan Planner::plan(const Reference& reference, double from_s, double to_s,
                           const std::stop_token& stop) {
  PressurePlan result;
  result.start_s = from_s;
  result.step_s = step_s_;
  result.reference = reference;
  model::Chain<double> chain = finger();
  result.pressure_kpa.push_back(command_kpa());
  result.displacement_mm.push_back(chain.after(model::Station::load));

  const auto wanted_at = [&](std::size_t i) {
    return limit_reference(limits_, reference.value_at(from_s + static_cast<double>(i) * step_s_))
        .reference_mm;
  };
  const auto in_proportion = [&](double displacement_mm) {
    return in_range(limits_, settled_.pressure_kpa(displacement_mm));
  };
  const auto points = static_cast<std::size_t>(std::ceil((to_s - from_s) / step_s_ - 1e-9)) + 1;
  const auto keep = static_cast<std::size_t>(std::lround(decided_s / step_s_));
  const auto look = static_cast<std::size_t>(std::lround(ahead_s / step_s_));
  const auto n = static_cast<Eigen::Index>(keep + look);
  double squares = 0;
  Vector guess;
  for (std::size_t done = 1; done < points && !stop.stop_requested();) {
    Vector wanted(n);
    for (Eigen::Index i = 0; i < n; ++i) wanted[i] = wanted_at(done + static_cast<std::size_t>(i));
    // The initial guess is the rest of the previous window, extended in proportion to the reference. The
    // initial guess is not constant, because the slope of the hysteresis depends on the direction of the
    // pressure.
    const Vector proportional = wanted.unaryExpr(in_proportion);
    const Eigen::Index known = guess.size();
    guess.conservativeResize(n);
    guess.tail(n - known) = proportional.tail(n - known);
    const double before = past_kpa_.size() > 1 ? past_kpa_[past_kpa_.size() - 2] : command_kpa();
    Window window(chain, {command_kpa(), before}, std::move(wanted), limits_, step_s_);
    const Vector u = best_of(window, guess, proportional);
    result.iterations += window.iterations();
    const std::size_t now = std::min(keep, points - done);
    for (std::size_t i = 0; i < now; ++i) {
      add_point(u[static_cast<Eigen::Index>(i)], chain, result);
      const double miss = std::abs(result.displacement_mm.back() - wanted_at(done + i));
      squares += miss * miss;
      result.worst_mm = std::max(result.worst_mm, miss);
    }
    done += now;
    guess = u.tail(n - static_cast<Eigen::Index>(now));
  }
  result.rmse_mm = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(points - 1, 1)));
  return result;
}

}  // namespace softgrip::control
