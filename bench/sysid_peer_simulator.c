/* Simulates the default model structure (Bouc-Wen with exponent 1 plus Kelvin-Voigt branches) for the
 * optimisers of other programs. Like softgrip's simulator, this simulator is exact if the command is linear
 * between samples. The code is plain C, so that ctypes and an Octave mex file can call it. */
#include <math.h>
#include <stddef.h>

/* Returns (1 - exp(-z)) / z. */
static double phi1(double z) {
  return fabs(z) < 1e-5 ? 1 - z * (0.5 - z / 6) : -expm1(-z) / z;
}

/* Returns the state h after a monotone change dp of the pressure. Between the sign changes of h, the solution
 * is in closed form. */
static double bouc_wen(double h, double dp, double beta, double gamma, double eta) {
  for (int part = 0; part < 2 && dp != 0; ++part) {
    const double direction = dp > 0 ? 1 : -1;
    const double sign = h > 0 ? 1 : h < 0 ? -1 : direction;
    const double kappa = gamma * sign + eta * direction;
    const double next = h + (beta - kappa * h) * dp * phi1(kappa * dp);
    if (h == 0 || next == 0 || (next > 0) == (h > 0)) return next;
    /* h reaches zero within the step: kappa * s = log(1 - kappa h / beta) */
    const double s = fabs(kappa) > 0 ? log1p(-kappa * h / beta) / kappa : -h / beta;
    dp -= s;
    h = 0;
  }
  return h;
}

/* Simulates n samples with the times t and the pressures p, and writes the readings to y. The parameters x
 * are alpha, beta, gamma, eta, k0, then k_i and c_i for each branch, then the offset of y. The finger starts
 * at rest with p = 0 before the first sample. */
void simulate(size_t n, const double* t, const double* p, int branches, const double* x, double* y) {
  const double alpha = x[0], beta = x[1], gamma = x[2], eta = x[3], k0 = x[4];
  const double offset = x[5 + 2 * branches];
  double v[8] = {0}, loss[8], to_begin[8], to_rise[8];
  double last_dt = -1;
  double h = bouc_wen(0, p[0], beta, gamma, eta);
  y[0] = alpha * p[0] - h + p[0] / k0 + offset;
  for (size_t i = 1; i < n; ++i) {
    const double dt = t[i] - t[i - 1];
    const double dp = p[i] - p[i - 1];
    if (fabs(dt - last_dt) > 1e-12) {
      for (int b = 0; b < branches; ++b) {
        const double k = x[5 + 2 * b], c = x[6 + 2 * b];
        const double z = dt * k / c, f = phi1(z);
        loss[b] = z * f;
        to_begin[b] = z * f / k;
        to_rise[b] = (1 - f) / k;
      }
      last_dt = dt;
    }
    h = bouc_wen(h, dp, beta, gamma, eta);
    double sum = alpha * p[i] - h + p[i] / k0 + offset;
    for (int b = 0; b < branches; ++b) {
      v[b] += to_begin[b] * p[i - 1] + to_rise[b] * dp - loss[b] * v[b];
      sum += v[b];
    }
    y[i] = sum;
  }
}
