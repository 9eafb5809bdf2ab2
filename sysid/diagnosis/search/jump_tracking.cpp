#include "sysid/diagnosis/search/jump_tracking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "model/chain.h"
#include "model/named.h"
#include "sysid/fitting/trajectory.h"
#include "sysid/fitting/trajectory_walk.h"

namespace softgrip::sysid {
namespace {

constexpr std::size_t most_tracks = 40;
constexpr std::size_t most_jump_targets = 24;
/// A path is removed if its squared error exceeds the squared error of the best path by more than a limit.
/// The limit is this number times the squared resolution, converted from kPa to mm.
constexpr double hopeless_resolutions = 4000;
/// Number of samples after which the paths are compared if there is no jump. After a jump, the paths are
/// compared at once.
constexpr std::size_t look_again = 32;
/// Limit for the change of the command during the sample of a jump, as a share of the band. At a larger
/// change, the time of the jump is not well resolved.
constexpr double slow_share = 0.2;

constexpr std::size_t no_jump = std::numeric_limits<std::size_t>::max();

struct Jump {
  std::size_t sample = 0;
  double held_kpa = 0;
  double distance_kpa = 0;
  bool resolved = false;
  std::size_t before = no_jump;  ///< index of the previous jump of this path
};

struct Track {
  model::Chain<double> chain;
  double held_kpa = 0;
  double cost_mm2 = 0;
  std::size_t last = no_jump;
};

/// A list of tracks that reuses memory. The memory of a removed track is kept, and the next track that is
/// added is copied into it.
class Tracks {
 public:
  void clear() { count_ = 0; }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] Track& operator[](std::size_t i) { return all_[i]; }
  [[nodiscard]] std::span<Track> span() { return std::span(all_).first(count_); }

  Track& add_copy(const Track& track) {
    if (count_ == all_.size())
      all_.push_back(track);
    else
      all_[count_] = track;
    return all_[count_++];
  }
  /// Moves `track` into the list. The value of `track` is unspecified after the call.
  Track& take(Track& track) {
    if (count_ == all_.size())
      all_.push_back(track);
    else
      std::swap(all_[count_], track);
    return all_[count_++];
  }

 private:
  std::vector<Track> all_;  ///< tracks in use (the first `count_`) and unused memory
  std::size_t count_ = 0;
};

/// Removes the whole samples from the transport delay of the model and returns their number. A jump is
/// visible in the readings only after this number of samples. Before, the readings cannot distinguish a path
/// with the jump from a path without the jump.
std::size_t take_whole_samples(model::Model& model, const Record& record) {
  model::BlockSpec* delay = model::find_block<model::TransportDelay>(model);
  if (delay == nullptr || record.sample_time_s <= 0) return 0;
  double& delay_s = model::value<model::TransportDelay>(*delay, "delay_s");
  const double most = static_cast<double>(record.size() - 1);
  const double samples = std::clamp(std::floor(delay_s / record.sample_time_s), 0.0, most);
  delay_s -= samples * record.sample_time_s;
  return static_cast<std::size_t>(samples);
}

class JumpTracker {
 public:
  JumpTracker(const Record& record, const FitPoint& point, const StartState& start, double band_kpa,
              double resolution_kpa, double worth_mm2)
      : record_(record), band_kpa_(band_kpa), resolution_kpa_(resolution_kpa), worth_mm2_(worth_mm2) {
    model::Model behind = point.model;
    seen_later_ = take_whole_samples(behind, record);
    Track first{model::Chain<double>(behind, {}, record.sample_time_s), record.drive_kpa.front(), 0, no_jump};
    sysid::start(first.chain, record, start.peak_before_kpa, start);
    start_mm_.resize(record.size());
    add_start(point.model, record, start, start_mm_);
    const double gain = record.largest_kpa > 0 ? record.span_mm / record.largest_kpa : 1;
    give_up_mm2_ = hopeless_resolutions * resolution_kpa * resolution_kpa * gain * gain;
    tracks_.take(first);
  }

  ValvePath run() {
    for (std::size_t i = 1; i + seen_later_ < record_.size(); ++i) {
      step(i);
      if (is_beaten_) return {{}, {}, std::numeric_limits<double>::infinity()};
    }
    return path();
  }

 private:
  void step(std::size_t i) {
    around_ = surroundings_at(record_, i + seen_later_);
    const double to = drive_at_end(record_, i);
    const double from = record_.held ? to : record_.drive_kpa[i - 1];
    next_.clear();
    bool any_jump = false;
    for (Track& track : tracks_.span()) {
      const std::vector<double>& jump_targets = jump_targets_of(track.held_kpa, from, to);
      any_jump |= !jump_targets.empty();
      for (const double held : jump_targets) {
        Track& child = next_.add_copy(track);
        child.last = jumps_.size();
        jumps_.push_back({i, held, std::abs(held - track.held_kpa),
                          !record_.held && std::abs(to - from) < slow_share * band_kpa_ && to != from,
                          track.last});
        advance(child, i, held);
      }
      if (std::abs(to - track.held_kpa) <= breaks_loose_by * band_kpa_ || jump_targets.empty()) {
        advance(track, i, track.held_kpa);
        next_.take(track);
      }
    }
    if (any_jump || i % look_again == 0 || i + seen_later_ + 1 == record_.size()) {
      prune();
    } else {
      std::swap(tracks_, next_);
    }
  }

  void advance(Track& track, std::size_t i, double held_kpa) {
    track.held_kpa = held_kpa;
    const std::size_t seen = i + seen_later_;
    const double y = track.chain.step(record_.duration_s[i], held_kpa, around_) + start_mm_[seen];
    const double error = record_.reading_mm[seen] - y;
    if (!std::isnan(error)) track.cost_mm2 += error * error;
  }

  /// Returns the possible positions of the valve after a jump. The valve jumps from the position `held` while
  /// the command changes from `from` to `to`.
  const std::vector<double>& jump_targets_of(double held, double from, double to) {
    jump_targets_.clear();
    if (from == to) {
      if (std::abs(to - held) > breaks_loose_from * band_kpa_) jump_targets_.push_back(to);
      return jump_targets_;
    }
    const double way = to > from ? 1 : -1;
    const double loose = std::max(way * from, way * held + breaks_loose_from * band_kpa_);
    const double first = std::max(loose, way * to - breaks_loose_by * band_kpa_);
    const double length = way * to - first;
    if (length < 0) return jump_targets_;
    const auto parts = std::clamp<std::size_t>(static_cast<std::size_t>(std::ceil(length / resolution_kpa_)),
                                               1, most_jump_targets);
    for (std::size_t k = 0; k < parts; ++k) {
      const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(parts);
      jump_targets_.push_back(way * (first + share * length));
    }
    return jump_targets_;
  }

  /// Keeps the best paths and removes all others. If several paths have the same valve position, keeps only
  /// one of them.
  void prune() {
    order_.resize(next_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(),
              [&](std::size_t a, std::size_t b) { return next_[a].cost_mm2 < next_[b].cost_mm2; });
    const double least_mm2 = next_[order_.front()].cost_mm2;
    is_beaten_ = least_mm2 > worth_mm2_;  // further samples can only increase the sum of squares
    const double most_mm2 = least_mm2 + give_up_mm2_;
    tracks_.clear();
    for (const std::size_t at : order_) {
      Track& track = next_[at];
      if (tracks_.size() >= most_tracks || track.cost_mm2 > most_mm2) break;
      // Paths with the same valve position have the same future, so only the best one is kept. The limited
      // number of paths then covers more positions.
      const bool duplicate = std::ranges::any_of(tracks_.span(), [&](const Track& kept) {
        return std::abs(kept.held_kpa - track.held_kpa) < resolution_kpa_;
      });
      if (!duplicate) tracks_.take(track);
    }
  }

  [[nodiscard]] ValvePath path() {
    ValvePath found;
    found.held_kpa.assign(record_.size(), record_.drive_kpa.front());
    found.sum_of_squares_mm2 = tracks_[0].cost_mm2;
    std::size_t end = record_.size();
    for (std::size_t at = tracks_[0].last; at != no_jump; at = jumps_[at].before) {
      const Jump& jump = jumps_[at];
      std::fill(found.held_kpa.begin() + static_cast<long>(jump.sample),
                found.held_kpa.begin() + static_cast<long>(end), jump.held_kpa);
      end = jump.sample;
      if (jump.resolved) found.distances_kpa.push_back(jump.distance_kpa);
    }
    std::reverse(found.distances_kpa.begin(), found.distances_kpa.end());
    return found;
  }

  const Record& record_;
  double band_kpa_, resolution_kpa_, worth_mm2_;
  std::size_t seen_later_ = 0;  ///< number of samples from a jump to the first reading in which the jump is
                                ///< visible
  double give_up_mm2_ = 0;
  bool is_beaten_ = false;
  std::vector<double> start_mm_;
  model::Surroundings around_;
  Tracks tracks_, next_;
  std::vector<Jump> jumps_;
  std::vector<double> jump_targets_;
  std::vector<std::size_t> order_;
};

}  // namespace

ValvePath track_jumps(const Record& record, std::size_t index, const FitPoint& point, double band_kpa,
                      double resolution_kpa, double worth_mm2) {
  return JumpTracker(record, point, point.starts[index], band_kpa, resolution_kpa, worth_mm2).run();
}

Record driven_by(const Record& record, const ValvePath& path) {
  Record driven = record;
  for (std::size_t i = 1; i < record.size(); ++i) {
    driven.drive_kpa[record.held ? i - 1 : i] = path.held_kpa[i];
  }
  return driven;
}

}  // namespace softgrip::sysid
