#pragma once
// One number of all fingers of a rig through their days: the charts, and whose change it is that they show.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sysid/health/finger_track.h"
#include "sysid/health/rig_health.h"

namespace softgrip::sysid::health {

class NumberWatch {
 public:
  /// @param tracks  placed in time; they outlive this, which adds alarms, references and judgements to them.
  NumberWatch(std::size_t number, std::vector<FingerTrack>& tracks, const HealthOptions& options);

  /// Through all moments, once. Returns what the rig shares.
  [[nodiscard]] std::vector<SharedChange> run(std::size_t moments);

 private:
  /// The peer fingers of a finger: index and number of repairs.
  using PeerFingers = std::vector<std::pair<std::size_t, std::size_t>>;

  struct Watched {
    ControlChart own, beside;
    std::vector<std::size_t> own_at{}, beside_at{};  ///< the finger's point of each of the chart's
    PeerFingers peers{};
    std::size_t epoch = 0;
    std::size_t next = 0;  ///< point
    std::optional<HealthAlarm> alarm{};
    std::optional<std::size_t> shared{};  ///< since the last note; index
    /// Knowledge since the last maintenance record, also before a shared change: slopes by recipe, spread.
    std::map<std::string, double> per_c{};
    double widest_spread = 0;
  };

  void add_own(std::size_t finger, std::size_t moment);
  void add_beside(std::size_t finger, std::size_t moment);
  void decide(std::size_t moment);
  /// The finger whose difference is most surely its own change, where it is sure enough.
  [[nodiscard]] std::optional<std::size_t> changed_finger() const;
  [[nodiscard]] bool is_shared(std::size_t finger) const;
  void raise(std::size_t finger, bool beside);
  void share(std::size_t finger);
  /// An epoch of a finger is over.
  void close(std::size_t finger);
  [[nodiscard]] HealthAlarm alarm_of(std::size_t finger, bool beside) const;

  [[nodiscard]] PeerFingers peers_of(std::size_t finger) const;
  [[nodiscard]] std::vector<std::string> names_of(const PeerFingers& peers) const;
  [[nodiscard]] ChartValues difference_at(std::size_t finger, std::size_t point,
                                          const PeerFingers& peers) const;
  /// Into the points, as the chart of differences sees them.
  void note_differences(std::size_t finger);
  void compare_again(std::size_t finger, PeerFingers peers);

  /// By how much the finger's own values moved: the last of them since `from` against those before.
  [[nodiscard]] std::optional<double> moved(std::size_t finger, std::size_t from_moment) const;
  [[nodiscard]] std::optional<double> peers_moved(std::size_t finger, std::size_t from_moment) const;
  /// Returns the variance of moved() in control.
  [[nodiscard]] double usual_variance(std::size_t finger) const;
  [[nodiscard]] std::size_t moment_of(std::size_t finger, std::size_t point) const;
  /// The finger's points since its last note that have the number, as far as they were looked at.
  [[nodiscard]] std::vector<std::size_t> points_of(std::size_t finger) const;
  [[nodiscard]] ControlChart new_chart(std::size_t finger) const;

  std::size_t number_;
  std::vector<FingerTrack>& tracks_;
  ChartLimits limits_;
  std::vector<Watched> watched_;
  std::vector<SharedChange> shared_;
  std::vector<std::vector<std::size_t>> have_runs_in_common_;  ///< by finger
};

}  // namespace softgrip::sysid::health
