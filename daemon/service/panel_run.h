#pragma once
// Runs the panel in its own thread: opens the digital lines, reads and writes them, and releases them at the
// end.

#include <optional>

#include "daemon/loop/real_time.h"
#include "daemon/loop/thread.h"
#include "daemon/panel/panel.h"
#include "daemon/service/daemon.h"

namespace softgrip::daemon {

/// The thread of the panel. For a rig without digital lines, there is no thread. All referenced objects must
/// exist longer than this object.
class PanelRun {
 public:
  PanelRun(const rig::RigFile& rig, const DaemonOptions& options, const Clock& clock, SharedState& shared,
           const LoopStatistics& loop)
      : rig_(rig), options_(options), clock_(clock), shared_(shared), loop_(loop) {}
  PanelRun(const PanelRun&) = delete;
  PanelRun& operator=(const PanelRun&) = delete;
  PanelRun(PanelRun&&) = delete;
  PanelRun& operator=(PanelRun&&) = delete;
  ~PanelRun() { stop(); }

  /// Requests the digital lines from the kernel. If the request fails, returns false and sets `ending` and
  /// `message` of `outcome`.
  bool open(Outcome& outcome);
  /// Starts the thread that reads and writes the lines. Adds the result of the thread's scheduling to
  /// `report`.
  void start(RealTimeReport& report);
  /// Switches off the enable output and ends the thread of the panel.
  void stop() noexcept;

 private:
  const rig::RigFile& rig_;
  const DaemonOptions& options_;
  const Clock& clock_;
  SharedState& shared_;
  const LoopStatistics& loop_;
  std::optional<Panel> panel_;
  std::optional<PanelGuard> guard_;
  Thread thread_;
};

}  // namespace softgrip::daemon
