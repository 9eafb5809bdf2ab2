#include "tools/exporting/c_source.h"

namespace softgrip::tools::c_text {

const std::string_view common = R"(
/* Segment of a signal: the parabola with the values `begin` and `end` at its ends and the mean value `mean`. */
typedef struct { double duration_s, begin, end, mean; } segment;
typedef void (*next_block)(void *chain, segment in);

static segment straight(double duration_s, double begin, double end) {
  segment s;
  s.duration_s = duration_s;
  s.begin = begin;
  s.end = end;
  s.mean = (begin + end) * 0.5;
  return s;
}

static segment bent(double duration_s, double begin, double end, double mean) {
  segment s;
  s.duration_s = duration_s;
  s.begin = begin;
  s.end = end;
  s.mean = mean;
  return s;
}

static double bend_of(segment s) { return (s.mean - (s.begin + s.end) * 0.5) * 6.0; }

/* Coefficients of the response of dx/dt = gain_rate u - rate x to a segment of the input u. */
typedef struct {
  double loss, end_begin, end_rise, end_bend, mean_state, mean_begin, mean_rise, mean_bend;
} response;

static response response_of(double duration_s, double rate, double gain_rate) {
  const double z = duration_s * rate;
  const double g = duration_s * gain_rate;
  double phi1, phi2, phi3, phi4;
  response r;
  if (z < 0.5) {
    int i;
    double term = 1.0 / 20922789888000.0;
    double factorial = 20922789888000.0;
    for (i = 16; i > 4; --i) {
      factorial /= i;
      term = 1.0 / factorial - z * term;
    }
    phi4 = term;
    phi3 = 1.0 / 6.0 - z * phi4;
    phi2 = 0.5 - z * phi3;
    phi1 = 1.0 - z * phi2;
  } else {
    phi1 = -expm1(-z) / z;
    phi2 = (1.0 - phi1) / z;
    phi3 = (0.5 - phi2) / z;
    phi4 = (1.0 / 6.0 - phi3) / z;
  }
  r.loss = z * phi1;
  r.end_begin = g * phi1;
  r.end_rise = g * phi2;
  r.end_bend = g * (phi2 - 2.0 * phi3);
  r.mean_state = phi1;
  r.mean_begin = g * phi2;
  r.mean_rise = g * phi3;
  r.mean_bend = g * (phi3 - 2.0 * phi4);
  return r;
}

static double response_end(const response *r, double x, segment in) {
  return x - r->loss * x + r->end_begin * in.begin + r->end_rise * (in.end - in.begin) + r->end_bend * bend_of(in);
}

static double response_mean(const response *r, double x, segment in) {
  return r->mean_state * x + r->mean_begin * in.begin + r->mean_rise * (in.end - in.begin) +
         r->mean_bend * bend_of(in);
}
)";

const std::string_view bouc_wen = R"(
/* Bouc-Wen hysteresis with exponent 1. The output is alpha p - h; h is integrated exactly over the pressure p. */
typedef struct { double h, direction, output; } bouc_wen;

static double bouc_wen_rate(const double *v, double h, double direction) {
  return h * direction >= 0.0 ? v[2] + v[3] : v[2] - v[3];
}

static double bouc_wen_moved(const double *v, double h, double change, double direction) {
  const double k = bouc_wen_rate(v, h, direction) * (h * direction >= 0.0 ? direction : -direction);
  const double end = h + change * (v[1] - k * h) * phi_one(-k * change);
  double x, stretch, rest;
  if (h * end >= 0.0) return end;
  x = -k * h / v[1];
  stretch = fabs(x) < 1e-5 ? 1.0 - x * 0.5 + x * x * (1.0 / 3.0) : log1p(x) / x;
  rest = change + h / v[1] * stretch;
  return rest * v[1] * phi_one(-(bouc_wen_rate(v, 0.0, direction) * direction) * rest);
}

static double bouc_wen_reset(bouc_wen *b, const double *v, double input) {
  b->direction = input < 0.0 ? -1.0 : 1.0;
  b->h = bouc_wen_moved(v, 0.0, input, b->direction);
  b->output = v[0] * input - b->h;
  return b->output;
}

static double bouc_wen_slope(const double *v, double h, double direction) {
  return v[1] - bouc_wen_rate(v, h, direction) * fabs(h);
}

static segment bouc_wen_step(bouc_wen *b, const double *v, segment in) {
  const double change = in.end - in.begin;
  const double begin = b->output;
  const double before = b->h;
  double slope_before, slope_after, mean_h;
  if (change == 0.0) return bent(in.duration_s, begin, begin, begin);
  b->direction = change > 0.0 ? 1.0 : -1.0;
  b->h = bouc_wen_moved(v, before, change, b->direction);
  slope_before = bouc_wen_slope(v, before, b->direction);
  slope_after = bouc_wen_slope(v, b->h, b->direction);
  mean_h = (before + b->h) * 0.5 + change * (slope_before - slope_after) * (1.0 / 12.0) +
           (slope_before + slope_after) * 0.5 * (in.mean - (in.begin + in.end) * 0.5);
  b->output = v[0] * in.end - b->h;
  return bent(in.duration_s, begin, b->output, v[0] * in.mean - mean_h);
}
)";

const std::string_view prandtl_ishlinskii = R"(
/* Sum of play operators. v[0] is the largest load before the simulation starts. v[1], v[2] and v[3] are the bend,
   the skew and the end of the envelope. The threshold and the weight of each operator follow. */
typedef struct { double output, zero; int dragging, upwards; } play;

static double play_dragged(double input, double from, double reach) {
  if (input - reach > from) return input - reach;
  if (input + reach < from) return input + reach;
  return from;
}

/* Returns the mean of the output over the segment. */
static double play_step(play *o, double reach, segment in) {
  const double begin = o->output;
  const double end = play_dragged(in.end, begin, reach);
  int upwards, went_on;
  double side, start, share;
  segment moving;
  o->output = end;
  if (begin == end) {
    if (in.begin != in.end) o->dragging = 0;
    return begin;
  }
  upwards = end > begin;
  went_on = o->dragging && upwards == o->upwards;
  o->dragging = 1;
  o->upwards = upwards;
  side = upwards ? -reach : reach;
  start = begin - side;
  share = (start - in.begin) / (in.end - in.begin);
  if (went_on || !(share > 1e-12 && share < 1.0)) return in.mean + side;
  moving = part_beyond(in, fraction_at(in, start));
  return (begin * (in.duration_s - moving.duration_s) + (moving.mean + side) * moving.duration_s) / in.duration_s;
}

/* Returns the input of the play operators: the pressure, deformed by the envelope. */
static double enveloped(const double *v, double p) {
  const double left = 1.0 - p / v[3];
  if (p <= 0.0) return p * (1.0 - v[1] + v[2]);
  if (p >= v[3]) return v[3] + (p - v[3]) * (1.0 + v[1] + v[2]);
  return p * (1.0 - left * (v[1] + v[2] - 2.0 * v[2] * left));
}

static segment enveloped_segment(const double *v, segment in) {
  const double begin = enveloped(v, in.begin);
  const double end = enveloped(v, in.end);
  const double middle = enveloped(v, (in.begin + in.end) * 0.5 + bend_of(in) * 0.25);
  return bent(in.duration_s, begin, end, (begin + end + middle * 4.0) * (1.0 / 6.0));
}

static double prandtl_ishlinskii_reset(play *o, const double *v, int count, double input) {
  const int bends = v[1] != 0.0 || v[2] != 0.0;
  const double load = bends ? enveloped(v, v[0]) : v[0];
  const double seen = bends ? enveloped(v, input) : input;
  double sum = 0.0;
  int i;
  for (i = 0; i < count; ++i) {
    o[i].zero = play_dragged(0.0, play_dragged(load, 0.0, v[4 + 2 * i]), v[4 + 2 * i]);
    o[i].output = play_dragged(seen, o[i].zero, v[4 + 2 * i]);
    o[i].dragging = 0;
    o[i].upwards = 0;
    sum += v[5 + 2 * i] * (o[i].output - o[i].zero);
  }
  return sum;
}

static segment prandtl_ishlinskii_step(play *o, const double *v, int count, segment in) {
  double begin = 0.0, end = 0.0, mean = 0.0;
  int i;
  if (v[1] != 0.0 || v[2] != 0.0) in = enveloped_segment(v, in);
  for (i = 0; i < count; ++i) {
    begin += v[5 + 2 * i] * (o[i].output - o[i].zero);
    mean += v[5 + 2 * i] * (play_step(&o[i], v[4 + 2 * i], in) - o[i].zero);
    end += v[5 + 2 * i] * (o[i].output - o[i].zero);
  }
  return bent(in.duration_s, begin, end, mean);
}
)";

const std::string_view kelvin_voigt = R"(
/* Spring in series with branches. Each branch is a spring parallel to a dashpot. x[0] is the deflection of the
   first spring. The values are k0, then k and c of each branch. */
static double kelvin_voigt_reset(double *x, const double *v, int branches, double input) {
  double sum = x[0] = input / v[0];
  int i;
  for (i = 0; i < branches; ++i) sum += x[i + 1] = v[2 * i + 1] > 0.0 ? input / v[2 * i + 1] : 0.0;
  return sum;
}

static segment kelvin_voigt_step(double *x, const double *v, int branches, segment in) {
  double begin = x[0], end, mean = in.mean / v[0];
  int i;
  x[0] = end = in.end / v[0];
  for (i = 0; i < branches; ++i) {
    const response r = response_of(in.duration_s, v[2 * i + 1] / v[2 * i + 2], 1.0 / v[2 * i + 2]);
    begin += x[i + 1];
    mean += response_mean(&r, x[i + 1], in);
    end += x[i + 1] = response_end(&r, x[i + 1], in);
  }
  return bent(in.duration_s, begin, end, mean);
}
)";

const std::string_view pressure_dependent_creep = R"(
/* Creep above a pressure (hinge). The values are hinge, compliance and time constant of each branch. */
static segment above(segment in, double hinge) {
  const double first = in.begin >= hinge ? in.begin - hinge : 0.0;
  const double last = in.end >= hinge ? in.end - hinge : 0.0;
  double height;
  if (in.begin >= hinge && in.end >= hinge) return bent(in.duration_s, first, last, in.mean - hinge);
  if (in.begin < hinge && in.end < hinge) return bent(in.duration_s, first, last, 0.0);
  height = first > last ? first : last;
  return bent(in.duration_s, first, last, height * height * 0.5 / fabs(in.end - in.begin));
}

static double pressure_dependent_creep_reset(double *x, const double *v, int branches, double input) {
  double sum = 0.0;
  int i;
  for (i = 0; i < branches; ++i) sum += x[i] = v[3 * i + 1] * (input >= v[3 * i] ? input - v[3 * i] : 0.0);
  return sum;
}

static segment pressure_dependent_creep_step(double *x, const double *v, int branches, segment in) {
  double begin = 0.0, end = 0.0, mean = 0.0;
  int i;
  for (i = 0; i < branches; ++i) {
    const segment part = above(in, v[3 * i]);
    const response r = response_of(in.duration_s, 1.0 / v[3 * i + 2], v[3 * i + 1] / v[3 * i + 2]);
    begin += x[i];
    mean += response_mean(&r, x[i], part);
    end += x[i] = response_end(&r, x[i], part);
  }
  return bent(in.duration_s, begin, end, mean);
}
)";

const std::string_view characteristic = R"(
/* Static characteristic, curved from 0 to the span and straight outside. The values are curvature and span. */
static double characteristic_of(const double *v, double z) {
  if (z <= 0.0) return z / phi_one(v[0]);
  if (z >= v[1]) return v[1] + exp(v[0]) / phi_one(v[0]) * (z - v[1]);
  return z * (phi_one(v[0] / v[1] * z) / phi_one(v[0]));
}

static segment characteristic_step(double *output, const double *v, segment in) {
  const double begin = *output;
  const double end = characteristic_of(v, in.end);
  const double middle = characteristic_of(v, (in.begin + in.end) * 0.5 + bend_of(in) * 0.25);
  *output = end;
  return bent(in.duration_s, begin, end, (begin + end + middle * 4.0) * (1.0 / 6.0));
}
)";

const std::string_view inverse = R"(
static double body_after(const body *b, double from_kpa, double to_kpa) {
  body trial = *b;
  return body_step(&trial, straight(TICK_S, from_kpa, to_kpa));
}

/* Returns the pressure at which the displacement is wanted_mm: false position (Illinois) between lower and upper. */
static double body_solve(const body *b, double from_kpa, double wanted_mm, double lower, double upper) {
  const double tolerance_mm = 1e-11;
  double low = body_after(b, from_kpa, lower) - wanted_mm;
  double high = body_after(b, from_kpa, upper) - wanted_mm;
  double x = lower;
  int i, side = 0;
  if (low >= 0.0) return lower;
  if (high <= 0.0) return upper;
  for (i = 0; i < 100; ++i) {
    double miss;
    x = i % 8 == 7 ? 0.5 * (lower + upper) : (lower * high - upper * low) / (high - low);
    if (!(x > lower && x < upper)) return x <= lower ? lower : upper;
    miss = body_after(b, from_kpa, x) - wanted_mm;
    if (fabs(miss) <= tolerance_mm) return x;
    if (miss < 0.0) {
      lower = x;
      low = miss;
      if (side == -1) high *= 0.5;
      side = -1;
    } else {
      upper = x;
      high = miss;
      if (side == 1) low *= 0.5;
      side = 1;
    }
  }
  return x;
}
)";

}  // namespace softgrip::tools::c_text
