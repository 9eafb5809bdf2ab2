#pragma once
// Watches one indicator of all fingers of a rig: updates the control charts, and determines which finger has
// changed.

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
  /// @param number  index of the indicator.
  /// @param tracks  tracks that place_in_time() has processed. They must outlive this object, which adds
  /// alarms, references and standard normal values to them.
  NumberWatch(std::size_t number, std::vector<FingerTrack>& tracks, const HealthOptions& options);

  /// Processes all points of all fingers in order of time and returns the shared changes. Must be called only
  /// once.
  [[nodiscard]] std::vector<SharedChange> run(std::size_t moments);

 private:
  /// The peer fingers of a finger. An element contains the index of a peer finger and the number of its
  /// maintenance records so far.
  using PeerFingers = std::vector<std::pair<std::size_t, std::size_t>>;

  struct Watched {
    ControlChart own, beside;
    /// The charts `own` and `beside` contain some of the points of the finger. For each point of a chart: the
    /// index of this point in the list of all points of the finger.
    std::vector<std::size_t> own_at{}, beside_at{};
    PeerFingers peers{};
    std::size_t epoch = 0;
    std::size_t next = 0;  ///< index of the next point of the finger to be added
    std::optional<HealthAlarm> alarm{};
    /// Index of the newest shared change; empty if there was no shared change since the last maintenance
    /// record.
    std::optional<std::size_t> shared{};
    /// Temperature slope of each recipe since the last maintenance record, and largest standard deviation in
    /// this time. A shared change does not reset these values.
    std::map<std::string, double> per_c{};
    double widest_spread = 0;
  };

  void add_own(std::size_t finger, std::size_t moment);
  void add_beside(std::size_t finger, std::size_t moment);
  void decide(std::size_t moment);
  /// Returns the finger to which a change of the difference is attributed with the highest odds; nullopt if
  /// the odds of all fingers are below 20 to 1.
  [[nodiscard]] std::optional<std::size_t> changed_finger() const;
  [[nodiscard]] bool is_shared(std::size_t finger) const;
  void raise(std::size_t finger, bool beside);
  void share(std::size_t finger);
  /// Ends an epoch of a finger, which is the time between two maintenance records. Stores the differences and
  /// the alarm of this epoch in the health of the finger.
  void close(std::size_t finger);
  [[nodiscard]] HealthAlarm alarm_of(std::size_t finger, bool beside) const;

  [[nodiscard]] PeerFingers peers_of(std::size_t finger) const;
  [[nodiscard]] std::vector<std::string> names_of(const PeerFingers& peers) const;
  [[nodiscard]] ChartValues difference_at(std::size_t finger, std::size_t point,
                                          const PeerFingers& peers) const;
  /// Stores, for each point of the finger, how much the difference from the peer fingers deviates from the
  /// reference of this difference.
  void note_differences(std::size_t finger);
  void compare_again(std::size_t finger, PeerFingers peers);

  /// Returns the change of the finger's own values, corrected for the temperature: the mean of the latest
  /// values since `from_moment` minus the mean of the last values before `from_moment`.
  [[nodiscard]] std::optional<double> moved(std::size_t finger, std::size_t from_moment) const;
  [[nodiscard]] std::optional<double> peers_moved(std::size_t finger, std::size_t from_moment) const;
  /// Returns the variance of the result of moved() for a finger that has not changed.
  [[nodiscard]] double usual_variance(std::size_t finger) const;
  [[nodiscard]] std::size_t moment_of(std::size_t finger, std::size_t point) const;
  /// Returns the processed points of the finger that follow its last maintenance record and have the
  /// indicator.
  [[nodiscard]] std::vector<std::size_t> points_of(std::size_t finger) const;
  [[nodiscard]] ControlChart new_chart(std::size_t finger) const;

  std::size_t number_;
  std::vector<FingerTrack>& tracks_;
  ChartLimits limits_;
  std::vector<Watched> watched_;
  std::vector<SharedChange> shared_;
  /// For each finger, the fingers that can be its peers.
  std::vector<std::vector<std::size_t>> have_runs_in_common_;
};

}  // namespace softgrip::sysid::health
