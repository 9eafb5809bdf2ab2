#include "tests/model/reference.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace softgrip::model::testing {
namespace {

// An initial value problem with the state vector p, h, x1 .. xn. If the valve has no lag, the pressure p
// equals the delayed command and is not integrated.
struct Problem {
  const Physics& physics;
  double from_s = 0, from_kpa = 0, slope = 0;  // start time, start value and slope of the present linear
                                               // segment of the delayed command

  [[nodiscard]] double command(double t) const { return from_kpa + slope * (t - from_s); }
};

int right_hand_side(sunrealtype t, N_Vector y, N_Vector ydot, void* data) {
  const Problem& problem = *static_cast<Problem*>(data);
  const Physics& f = problem.physics;
  const sunrealtype* s = N_VGetArrayPointer(y);
  sunrealtype* d = N_VGetArrayPointer(ydot);
  const bool lag = f.lag_s > 0;
  const double p = lag ? s[0] : problem.command(t);
  const double rate = lag ? (problem.command(t) - s[0]) / f.lag_s : problem.slope;
  d[0] = lag ? rate : 0;
  const double h = s[1];
  const double size = std::pow(std::fabs(h), f.exponent - 1);
  d[1] = f.beta * rate - f.gamma * rate * size * std::fabs(h) - f.eta * std::fabs(rate) * size * h;
  for (std::size_t i = 0; i < f.k.size(); ++i) d[2 + i] = (p - f.k[i] * s[2 + i]) / f.c[i];
  return 0;
}

void require(int flag) {
  if (flag < 0) throw std::runtime_error("CVODE failed with " + std::to_string(flag));
}

}  // namespace

std::vector<double> integrate(const Physics& physics, const std::vector<double>& command_kpa,
                              double sample_time_s) {
  const double dt = sample_time_s;
  const std::size_t count = command_kpa.size();
  const double end_s = dt * static_cast<double>(count - 1);
  // Times at which the slope of the delayed command changes. Between two successive times, the delayed
  // command is linear.
  struct Corner {
    double at_s, kpa;
  };
  std::vector<Corner> corners{{0, 0}};
  if (physics.delay_s > 0) corners.push_back({physics.delay_s, 0});
  for (std::size_t i = 1; i < count; ++i) {
    const bool last = i + 1 == count;
    const double bend = last ? 1 : command_kpa[i + 1] - 2 * command_kpa[i] + command_kpa[i - 1];
    if (std::fabs(bend) > 1e-10)
      corners.push_back({physics.delay_s + dt * static_cast<double>(i), command_kpa[i]});
  }

  SUNContext context = nullptr;
#ifdef SUN_COMM_NULL
  require(SUNContext_Create(SUN_COMM_NULL, &context));  // SUNDIALS 7 and later versions need this argument
#else
  require(SUNContext_Create(nullptr, &context));
#endif
  const auto size = static_cast<sunindextype>(2 + physics.k.size());
  N_Vector y = N_VNew_Serial(size, context);
  N_VConst(0, y);
  void* cvode = CVodeCreate(CV_ADAMS, context);
  Problem problem{physics};
  require(CVodeInit(cvode, right_hand_side, 0, y));
  require(CVodeSStolerances(cvode, 1e-12, 1e-13));
  require(CVodeSetUserData(cvode, &problem));
  SUNNonlinearSolver solver = SUNNonlinSol_FixedPoint(y, 0, context);
  require(CVodeSetNonlinearSolver(cvode, solver));
  require(CVodeSetMaxNumSteps(cvode, 1000000));

  std::vector<double> displacement(count, 0);
  std::size_t next = 1;
  double t = 0;
  for (std::size_t i = 0; i + 1 < corners.size() && t < end_s; ++i) {
    const Corner& a = corners[i];
    const Corner& b = corners[i + 1];
    problem.from_s = a.at_s;
    problem.from_kpa = a.kpa;
    problem.slope = (b.kpa - a.kpa) / (b.at_s - a.at_s);
    require(CVodeReInit(cvode, t, y));
    const double stop = std::min(b.at_s, end_s);
    while (t < stop) {
      const double sample = dt * static_cast<double>(next);
      const double target = next < count ? std::min(sample, stop) : stop;
      if (target > t) {
        require(CVodeSetStopTime(cvode, target));
        require(CVode(cvode, target, y, &t, CV_NORMAL));
      }
      if (next < count && t >= sample - 1e-12) {
        const sunrealtype* s = N_VGetArrayPointer(y);
        const double p = physics.lag_s > 0 ? s[0] : problem.command(t);
        double sum = physics.alpha * p - s[1] + p / physics.k0;
        for (std::size_t j = 0; j < physics.k.size(); ++j) sum += s[2 + j];
        displacement[next++] = sum;
      }
    }
  }
  SUNNonlinSolFree(solver);
  CVodeFree(&cvode);
  N_VDestroy(y);
  SUNContext_Free(&context);
  return displacement;
}

}  // namespace softgrip::model::testing
