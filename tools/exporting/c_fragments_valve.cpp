// Fragments of the valve blocks, which tools/exporting/c_source.h declares.

#include "tools/exporting/c_source.h"

namespace softgrip::tools::c_text {

const std::string_view transport_delay = R"(
/* Dead time. A ring buffer stores the pieces of the input of the last delay_s. */
typedef struct { double duration_s, end, mean; } piece;
typedef struct {
  double front_begin;
  int head, count;
  piece line[DELAY_PIECES];
} transport_delay;

static void transport_delay_push(transport_delay *d, segment s) {
  piece *last = &d->line[(d->head + d->count) & (DELAY_PIECES - 1)];
  last->duration_s = s.duration_s;
  last->end = s.end;
  last->mean = s.mean;
  ++d->count;
}

static void transport_delay_pop(transport_delay *d) {
  d->front_begin = d->line[d->head].end;
  d->head = (d->head + 1) & (DELAY_PIECES - 1);
  --d->count;
}

static double transport_delay_reset(transport_delay *d, double delay_s, double input) {
  d->head = 0;
  d->count = 0;
  d->front_begin = input;
  if (delay_s > 0.0) transport_delay_push(d, straight(delay_s, input, input));
  return input;
}

static void transport_delay_step(transport_delay *d, double delay_s, segment in, void *chain, next_block next) {
  const double snap = 1e-9;
  double remaining = in.duration_s;
  if (delay_s <= 0.0) {
    next(chain, in);
    return;
  }
  transport_delay_push(d, in);
  while (remaining > 0.0 && d->count > 0) {
    piece *front = &d->line[d->head];
    const segment whole = bent(front->duration_s, d->front_begin, front->end, front->mean);
    if (whole.duration_s < remaining * (1.0 - snap)) {
      transport_delay_pop(d);
      remaining -= whole.duration_s;
      next(chain, whole);
    } else if (whole.duration_s <= remaining * (1.0 + snap)) {
      transport_delay_pop(d);
      next(chain, bent(remaining, whole.begin, whole.end, whole.mean));
      return;
    } else {
      const double share = remaining / whole.duration_s;
      const segment first = part_before(whole, share);
      const segment rest = part_beyond(whole, share);
      front->duration_s = whole.duration_s - remaining;
      front->end = rest.end;
      front->mean = rest.mean;
      d->front_begin = rest.begin;
      next(chain, bent(remaining, first.begin, first.end, first.mean));
      return;
    }
  }
}
)";

const std::string_view valve_lag = R"(
/* First-order lag. The segment is split at the time at which the output reaches the input. */
static void valve_lag_step(double *output, double tau, segment in, void *chain, next_block next) {
  const double begin = *output;
  double gap_begin, end;
  response r;
  if (tau <= 0.0) {
    *output = in.end;
    next(chain, in);
    return;
  }
  r = response_of(in.duration_s, 1.0 / tau, 1.0 / tau);
  end = response_end(&r, begin, in);
  *output = end;
  gap_begin = in.begin - begin;
  if (gap_begin * (in.end - end) < 0.0) {
    const double slope = (in.end - in.begin) / in.duration_s;
    const double turn_s = tau * log1p(-gap_begin / (slope * tau));
    const double rest_s = in.duration_s - turn_s;
    const double least_s = 1e-6 * in.duration_s;
    if (turn_s > least_s && rest_s > least_s) {
      const double peak = in.begin + slope * turn_s;
      next(chain, bent(turn_s, begin, peak, (in.begin + peak) * 0.5 - tau * (peak - begin) / turn_s));
      next(chain, bent(rest_s, peak, end, (peak + in.end) * 0.5 - tau * (end - peak) / rest_s));
      return;
    }
  }
  next(chain, bent(in.duration_s, begin, end, response_mean(&r, begin, in)));
}
)";

const std::string_view two_way_lag = R"(
/* First-order lag with one time constant for filling and one for venting. */
static void two_way_lag_go(double *output, double tau, segment in, void *chain, next_block next) {
  const double begin = *output;
  response r;
  if (tau <= 0.0) {
    *output = in.end;
    next(chain, bent(in.duration_s, begin, in.end, in.mean));
    return;
  }
  r = response_of(in.duration_s, 1.0 / tau, 1.0 / tau);
  *output = response_end(&r, begin, in);
  next(chain, bent(in.duration_s, begin, *output, response_mean(&r, begin, in)));
}

static void two_way_lag_step(double *output, double filling, double venting, segment in, void *chain,
                             next_block next) {
  const double gap = in.begin - *output;
  const double way = gap != 0.0 ? gap : in.end - in.begin;
  const double now = way >= 0.0 ? filling : venting;
  const double then = way >= 0.0 ? venting : filling;
  const double least_s = 1e-6 * in.duration_s;
  double turn_s = in.duration_s;
  double slope;
  if (filling <= 0.0 && venting <= 0.0) {
    *output = in.end;
    next(chain, in);
    return;
  }
  slope = (in.end - in.begin) / in.duration_s;
  if (gap * slope < 0.0) {
    turn_s = now <= 0.0 ? 0.0 : now * log1p(-gap / (slope * now));
    if (!(turn_s < in.duration_s)) turn_s = in.duration_s;
  }
  if (!(turn_s > least_s && in.duration_s - turn_s > least_s)) {
    two_way_lag_go(output, turn_s <= least_s ? then : now, in, chain, next);
    return;
  }
  two_way_lag_go(output, now, part_before(in, turn_s / in.duration_s), chain, next);
  two_way_lag_go(output, then, part_beyond(in, turn_s / in.duration_s), chain, next);
}
)";

const std::string_view rate_limit = R"(
/* Limit of the rate of change. The segment is split at the time at which the output reaches the input. */
static void rate_limit_go(double *output, double s_per_kpa, double duration_s, void *chain, next_block next) {
  const double begin = *output;
  *output = begin + duration_s / s_per_kpa;
  next(chain, straight(duration_s, begin, *output));
}

static void rate_limit_follow(double *output, double filling, double venting, segment in, void *chain,
                              next_block next) {
  const double begin = *output;
  const double rise = in.end - begin;
  const double s_per_kpa = rise > 0.0 ? filling : venting;
  if (fabs(rise) * s_per_kpa > in.duration_s) {
    rate_limit_go(output, rise > 0.0 ? s_per_kpa : -s_per_kpa, in.duration_s, chain, next);
    return;
  }
  *output = in.end;
  next(chain, bent(in.duration_s, begin, in.end, in.mean));
}

static void rate_limit_step(double *output, double filling, double venting, segment in, void *chain,
                            next_block next) {
  const double gap = in.begin - *output;
  const double s_per_kpa = gap > 0.0 ? filling : -venting;
  const double least_s = 1e-6 * in.duration_s;
  double meeting_s = in.duration_s;
  if (gap == 0.0 || s_per_kpa == 0.0) {
    meeting_s = 0.0;
  } else {
    const double closing = 1.0 / s_per_kpa - (in.end - in.begin) / in.duration_s;
    if (gap * closing > 0.0 && gap / closing < in.duration_s) meeting_s = gap / closing;
  }
  if (meeting_s <= least_s) {
    rate_limit_follow(output, filling, venting, in, chain, next);
    return;
  }
  if (in.duration_s - meeting_s <= least_s) {
    rate_limit_go(output, s_per_kpa, in.duration_s, chain, next);
    return;
  }
  rate_limit_go(output, s_per_kpa, meeting_s, chain, next);
  in = straight(in.duration_s - meeting_s, *output, in.end);
  rate_limit_follow(output, filling, venting, in, chain, next);
}
)";

}  // namespace softgrip::tools::c_text
