#pragma once
// One master per board: who drives it holds a lock that no file of ours can lose.

#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "rig/rig_file.h"

namespace softgrip::daemon {

/// What of the outside world a rig drives: "modbus 192.168.1.5 port 502 unit 1", a serial device or a
/// converter by its real path; one entry each. Empty for a simulated board.
[[nodiscard]] std::vector<std::string> driven_by(const rig::RigFile& rig);

/// Held by this process until it ends, however it ends. It binds the processes of one machine (of one network
/// namespace); another machine on the same Modbus TCP board is noticed on the wire instead (F304).
class BoardLock {
 public:
  /// Takes all that the rig drives, or says who has it.
  [[nodiscard]] static tl::expected<BoardLock, std::string> take(const rig::RigFile& rig);

 private:
  std::vector<Descriptor> held_;
};

}  // namespace softgrip::daemon
