#include "sysid/fitting/separable.h"

#include <algorithm>
#include <cmath>

#include "model/dual.h"
#include "model/exponential.h"

namespace softgrip::sysid {
namespace {

using model::Dual;
using model::ExponentialWeights;
using model::Segment;
using Number = Dual<double>;

/// Assigns an index to each distinct duration. A duration is compared only with the last 8 distinct
/// durations. This is sufficient, because a log either alternates between a few durations or has many
/// different durations.
class DurationTable {
 public:
  explicit DurationTable(std::vector<double>& durations) : durations_(durations) {}

  std::uint32_t index_of(double duration_s) {
    constexpr std::size_t remembered = 8;
    constexpr double same_s = 1e-12;
    const std::size_t first = durations_.size() > remembered ? durations_.size() - remembered : 0;
    for (std::size_t i = durations_.size(); i-- > first;) {
      if (std::abs(durations_[i] - duration_s) < same_s) return static_cast<std::uint32_t>(i);
    }
    durations_.push_back(duration_s);
    return static_cast<std::uint32_t>(durations_.size() - 1);
  }

 private:
  std::vector<double>& durations_;
};

/// A time interval in which the input pressure of the model is linear in time.
struct Piece {
  double duration_s;
  double end_kpa;
};

std::vector<Piece> pieces_of(const Record& record) {
  std::vector<Piece> pieces;
  pieces.reserve((record.held ? 2 : 1) * record.size());
  for (std::size_t i = 1; i < record.size(); ++i) {
    if (record.held) {
      pieces.push_back({0, record.drive_kpa[i - 1]});
      pieces.push_back({record.duration_s[i], record.drive_kpa[i - 1]});
    } else {
      pieces.push_back({record.duration_s[i], record.drive_kpa[i]});
    }
  }
  return pieces;
}

void append_straight(PressureWalk& walk, double begin_kpa, double end_kpa, double duration_s,
                     std::uint32_t index, bool ends_sample) {
  Stretch s;
  s.end_kpa = end_kpa;
  s.mean_kpa = (begin_kpa + end_kpa) * 0.5;
  s.duration = index;
  s.rate_kpa_per_s = duration_s > 0 ? (end_kpa - begin_kpa) / duration_s : 0;
  s.ends_sample = ends_sample;
  walk.stretches.push_back(s);
}

/// Appends the linear pieces of the input pressure to `walk`, for a chain without delay.
void append_undelayed(PressureWalk& walk, const std::vector<Piece>& pieces, DurationTable& durations) {
  double last = walk.first_kpa;
  for (const Piece& piece : pieces) {
    append_straight(walk, last, piece.end_kpa, piece.duration_s, durations.index_of(piece.duration_s),
                    piece.duration_s > 0);
    last = piece.end_kpa;
  }
}

/// Delays the linear pieces of the input pressure by `delay_s` [s], splits them at the samples of the record
/// and appends them to `walk`.
void append_delayed(PressureWalk& walk, const Record& record, const std::vector<Piece>& pieces,
                    double delay_s, DurationTable& durations) {
  std::size_t next = 0;  // index of the piece after the current one
  Piece current{delay_s, walk.first_kpa};
  double at = walk.first_kpa;  // pressure at the beginning of the current piece
  for (std::size_t i = 1; i < record.size(); ++i) {
    double remaining = record.duration_s[i];
    while (remaining > 0) {
      constexpr double snap = 1e-9;
      if (current.duration_s < remaining * (1 - snap)) {
        append_straight(walk, at, current.end_kpa, current.duration_s, durations.index_of(current.duration_s),
                        false);
        remaining -= current.duration_s;
        at = current.end_kpa;
        current = pieces[next++];
        continue;
      }
      if (current.duration_s <= remaining * (1 + snap)) {
        append_straight(walk, at, current.end_kpa, remaining, durations.index_of(remaining), true);
        at = current.end_kpa;
        if (next < pieces.size()) current = pieces[next++];
      } else {
        const double end = at + (current.end_kpa - at) * (remaining / current.duration_s);
        append_straight(walk, at, end, remaining, durations.index_of(remaining), true);
        current.duration_s -= remaining;
        at = end;
      }
      break;
    }
  }
}

/// Filters the linear segments with a lag, as model::ValveLag does, and computes the derivatives with respect
/// to the time constant.
void apply_lag(PressureWalk& walk, double lag_s) {
  const Number rate = Number(1.0) / Number(lag_s, 1);
  std::vector<ExponentialWeights<Number>> weights;
  weights.reserve(walk.duration_s.size());
  for (const double d : walk.duration_s)
    weights.push_back(ExponentialWeights<Number>::make(Number(d), rate, rate));
  double in_begin = walk.first_kpa;
  Number out(walk.first_kpa);
  for (Stretch& s : walk.stretches) {
    const double in_end = s.end_kpa;
    const double duration = walk.duration_s[s.duration];
    if (duration > 0) {
      const Segment<Number> in =
          Segment<Number>::straight(Number(duration), Number(in_begin), Number(in_end));
      const ExponentialWeights<Number>& w = weights[s.duration];
      const Number begin = out;
      out = w.end(begin, in, Number(0));
      const Number mean = w.mean(begin, in, Number(0));
      s.mean_kpa = mean.a;
      s.mean_by_lag = mean.v;
      const double gap_begin = in_begin - begin.a;
      const double gap_end = in_end - out.a;
      const double slope = (in_end - in_begin) / duration;
      if (gap_begin * gap_end < 0) {
        const Number lag(lag_s, 1);
        const Number turn_s = lag * log1p((begin - in_begin) / (lag * slope));
        if (turn_s.a > 1e-6 * duration && turn_s.a < (1 - 1e-6) * duration) {
          s.turn_kpa = in_begin + slope * turn_s.a;
          s.turn_by_lag = slope * turn_s.v;
        }
      }
      s.rate_kpa_per_s = gap_end / lag_s;
    } else {
      s.mean_kpa = out.a;
      s.mean_by_lag = out.v;
    }
    s.end_kpa = out.a;
    s.end_by_lag = out.v;
    in_begin = in_end;
  }
}

}  // namespace

PressureWalk walk_pressure(const Record& record, double delay_s, double lag_s) {
  PressureWalk walk;
  walk.first_kpa = record.drive_kpa.front();
  const std::vector<Piece> pieces = pieces_of(record);
  walk.stretches.reserve(pieces.size() * (delay_s > 0 ? 2 : 1) + 2);
  DurationTable durations(walk.duration_s);
  if (delay_s > 0) {
    append_delayed(walk, record, pieces, delay_s, durations);
  } else {
    append_undelayed(walk, pieces, durations);
  }
  if (lag_s > 0) apply_lag(walk, lag_s);
  return walk;
}

}  // namespace softgrip::sysid
