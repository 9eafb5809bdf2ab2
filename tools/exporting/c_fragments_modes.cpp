#include "tools/exporting/c_source.h"

namespace softgrip::tools::c_text {

const std::string_view linear_modes = R"(
/* Second-order modes; the values are the direct gain, and period, damping ratio, gain and lead of each mode. */
typedef struct { double value, rate; } mode;

/* exp(-d w t) cosh(r t) and exp(-d w t) sinh(r t) / r, where -d w +- r are the poles. */
static void mode_decay(double w, double d, double t, double *cosine, double *sine) {
  const double distance = 1.0 - d * d;
  if (fabs(distance) < 1e-6) {
    const double square = w * w * distance * t * t;
    *cosine = exp(-d * w * t) * (1.0 - square * 0.5);
    *sine = exp(-d * w * t) * t * (1.0 - square * (1.0 / 6.0));
  } else if (distance < 0.0) {
    const double root = sqrt(d * d - 1.0);
    const double slow = exp(-w * t / (d + root));
    const double gone = -expm1(-2.0 * w * root * t);
    *cosine = slow * (1.0 - 0.5 * gone);
    *sine = slow * gone / (2.0 * w * root);
  } else {
    const double ringing = w * sqrt(distance);
    *cosine = exp(-d * w * t) * cos(ringing * t);
    *sine = exp(-d * w * t) * sin(ringing * t) / ringing;
  }
}

/* Power series in t / dt for a segment that is much shorter than the time constants. Returns the mean. */
static double mode_advance_by_series(mode *m, double w, double d, segment in) {
  const double bend = bend_of(in), angle = w * in.duration_s;
  double now = m->value, next = m->rate * in.duration_s;
  double value = now + next, rate = next, mean = now + next * 0.5;
  double input[20] = {0.0};
  int n;
  input[0] = in.begin;
  input[1] = in.end - in.begin + bend;
  input[2] = -bend;
  for (n = 0; n < 20; ++n) {
    const double after = angle * (angle * (input[n] - now) - 2.0 * d * (n + 1.0) * next) *
                         (1.0 / ((n + 1.0) * (n + 2.0)));
    now = next;
    next = after;
    value += next;
    rate += next * (n + 2.0);
    mean += next * (1.0 / (n + 3.0));
  }
  m->value = value;
  m->rate = rate / in.duration_s;
  return mean;
}

static void mode_move(mode *m, double w, double d, segment in) {
  const double dt = in.duration_s;
  const double bend = bend_of(in);
  const double c = -bend / (dt * dt);
  const double b = (in.end - in.begin + bend) / dt - 4.0 * d * c / w;
  const double a = in.begin - 2.0 * d * b / w - 2.0 * c / (w * w);
  const double offset = m->value - a, rate = m->rate - b;
  double cosine, sine;
  mode_decay(w, d, dt, &cosine, &sine);
  m->value = a + b * dt + c * dt * dt + (cosine + d * w * sine) * offset + sine * rate;
  m->rate = b + 2.0 * c * dt - w * w * sine * offset + (cosine - d * w * sine) * rate;
}

/* Returns the mean of the mode over the segment. */
static double mode_advance(mode *m, double w, double d, segment in) {
  const mode last = *m;
  const double angle = w * in.duration_s;
  double left;
  if (d < 1.0 ? angle < 1e-3 : 2.0 * d * angle < 1.0) return mode_advance_by_series(m, w, d, in);
  mode_move(m, w, d, in);
  left = (m->rate - last.rate) + 2.0 * d * w * (m->value - last.value);
  return in.mean - left / (w * w * in.duration_s);
}

static double linear_modes_reset(mode *m, const double *v, int modes, double input) {
  double sum = v[0] * input;
  int i;
  for (i = 0; i < modes; ++i) {
    m[i].value = input;
    m[i].rate = 0.0;
    sum += v[4 * i + 3] * input;
  }
  return sum;
}

static segment linear_modes_step(mode *m, const double *v, int modes, segment in) {
  double begin = v[0] * in.begin, end = v[0] * in.end, mean = v[0] * in.mean;
  int i;
  for (i = 0; i < modes; ++i) {
    const double *p = v + 4 * i + 1;
    const double w = 6.283185307179586 / p[0];
    const mode last = m[i];
    begin += p[2] * last.value + p[3] * last.rate / w;
    if (in.duration_s > 0.0) {
      mean += p[2] * mode_advance(&m[i], w, p[1], in);
      mean += p[3] * (m[i].value - last.value) / (w * in.duration_s);
    }
    end += p[2] * m[i].value + p[3] * m[i].rate / w;
  }
  return bent(in.duration_s, begin, end, mean);
}
)";

}  // namespace softgrip::tools::c_text
