#pragma once
// A whole rig under one seed: daemon, board, line, fingers, clients, a second master, disk, pauses of every
// thread. The same seed gives the same run, bit for bit.

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

/// What is the same in all worlds: read once.
struct Library {
  rig::RigFile rig;
  std::vector<std::shared_ptr<const daemon::LoadedSequence>> sequences;
  std::vector<Library> others;  ///< rigs that go to both sides of their rest pressure

  /// One seed in four has such a rig.
  [[nodiscard]] const Library& of(std::uint64_t seed) const {
    return seed % 4 == 3 && !others.empty() ? others[seed / 4 % others.size()] : *this;
  }
};
/// From the project's own example files. Throws std::runtime_error if these are refused.
[[nodiscard]] Library load_library();

struct WorldOptions {
  Tool tool = Tool::none;
  Nanoseconds length = 60 * ns_per_s;
  /// Instead of those that the seed draws.
  std::optional<std::vector<Incident>> incidents;
  /// Every write, tick with an event and incident, in words.
  bool trace = false;
  bool record = true;
  bool always_habits = false;  ///< else one seed in five has a board with habits
};

struct WorldResult {
  std::optional<Violation> violation;
  std::vector<Incident> incidents;
  std::string shape;  ///< of the rig, in a line
  std::vector<std::string> trace;
  std::uint64_t fingerprint = 0;  ///< of all writes with their times
  std::uint64_t ticks = 0, writes = 0, sequences = 0, holdings = 0, faults = 0, trips = 0, rows = 0;
  std::uint64_t growth_bytes = 0;  ///< the most that a daemon's heap grew after it had settled
  std::uint64_t descriptors = 0;   ///< the most that one had open
  Met met;                         ///< of the tool
};

[[nodiscard]] WorldResult run_world(const Library& library, std::uint64_t seed, const WorldOptions& options);

/// Fewer and shorter incidents with the same violation.
[[nodiscard]] std::vector<Incident> shrink(const Library& library, std::uint64_t seed,
                                           const WorldResult& failed, const WorldOptions& options);

}  // namespace softgrip::world
