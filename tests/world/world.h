#pragma once
// Simulates a whole rig: daemon, board, line, fingers, clients, a second Modbus client, disk, and pauses of
// every thread. A seed determines the simulation. Two simulations with the same seed are identical, bit for
// bit.

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/recording/sequence_store.h"
#include "rig/rig_file.h"
#include "tests/world/incident.h"
#include "tests/world/monitor.h"
#include "tests/world/tool.h"

namespace softgrip::world {

/// The files that all worlds use. They are read once.
struct Library {
  rig::RigFile rig;
  std::vector<std::shared_ptr<const daemon::LoadedSequence>> sequences;
  std::vector<Library> others;  ///< rigs whose pressure range extends above and below the rest pressure

  /// Returns the rig library for a seed. For one seed in four, the pressure range of its rig extends above
  /// and below the rest pressure.
  [[nodiscard]] const Library& of(std::uint64_t seed) const {
    return seed % 4 == 3 && !others.empty() ? others[seed / 4 % others.size()] : *this;
  }
};
/// Reads the project's own example files. Throws std::runtime_error if a file is refused.
[[nodiscard]] Library load_library();

struct WorldOptions {
  Tool tool = Tool::none;
  Nanoseconds length = 60 * ns_per_s;
  /// Incidents of the simulation; nullopt: the incidents are drawn from the seed.
  std::optional<std::vector<Incident>> incidents;
  /// True: the trace records every incident, every write and every tick with an event as text.
  bool trace = false;
  bool record = true;
  bool always_habits = false;  ///< true: every board has unusual properties; false: the boards of one seed in
                               ///< five have them
};

struct WorldResult {
  std::optional<Violation> violation;
  std::vector<Incident> incidents;
  std::string shape;  ///< description of the rig in one line of text
  std::vector<std::string> trace;
  std::uint64_t fingerprint = 0;  ///< hash of all writes to the board and their times
  std::uint64_t ticks = 0, writes = 0, sequences = 0, holdings = 0, faults = 0, trips = 0, rows = 0;
  std::uint64_t growth_bytes = 0;  ///< largest growth of the heap of a daemon after its start-up [bytes]
  std::uint64_t descriptors = 0;   ///< largest number of open descriptors of a daemon
  Met met;                         ///< numbers of calls of the tool and of incidents
};

[[nodiscard]] WorldResult run_world(const Library& library, std::uint64_t seed, const WorldOptions& options);

/// Removes incidents from the list as long as the violation still occurs. Returns the remaining list, which
/// is usually much shorter.
[[nodiscard]] std::vector<Incident> shrink(const Library& library, std::uint64_t seed,
                                           const WorldResult& failed, const WorldOptions& options);

}  // namespace softgrip::world
