#pragma once
// Ensures that only one softgrip program drives a board. The program holds a lock, which ends with the
// process.
//
// The lock has two parts. The first is a locked file in the runtime folder, which only root and the service
// can create. The second is the name of an abstract socket. This name also protects the board after the
// removal of the file, and between the users of the service's group. Each user of the machine can bind such a
// name, so the holder of the name is respected only if it is trusted (trusted_user.h).

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "daemon/service/runtime_folder.h"
#include "rig/rig_file.h"

namespace softgrip::daemon {

/// Returns the names of the devices that a rig drives: "modbus 192.168.1.5 port 502 unit 1", or the real path
/// of a serial device or a converter. The list is empty for a simulated board.
[[nodiscard]] std::vector<std::string> driven_by(const rig::RigFile& rig);

/// A file of the runtime folder that this process has locked. The destructor removes the file.
class LockedFile {
 public:
  LockedFile(std::shared_ptr<const RuntimeFolder> folder, std::string name, Descriptor file);
  LockedFile(const LockedFile&) = delete;
  LockedFile& operator=(const LockedFile&) = delete;
  LockedFile(LockedFile&&) noexcept = default;
  LockedFile& operator=(LockedFile&& other) noexcept;
  ~LockedFile();

 private:
  std::shared_ptr<const RuntimeFolder> folder_;
  std::string name_;
  Descriptor file_;
};

/// The purpose of a lock.
enum class LockPurpose : std::uint8_t {
  drive,
  /// To write the safe outputs. This purpose yields to another softgrip program that runs. It ignores a lock
  /// that cannot be created, and a holder that does not run (stopped, or blocked in a system call).
  vent,
};

/// The lock on the boards of a rig. The process holds it until it ends in any way. The lock excludes other
/// processes of the machine that share /run, and other processes of the network namespace. Another machine on
/// the same Modbus TCP board is detected on the network (F304).
class BoardLock {
 public:
  /// Locks all boards of the rig. The error names the program that holds a lock, or gives another reason.
  [[nodiscard]] static tl::expected<BoardLock, std::string> take(const rig::RigFile& rig,
                                                                 LockPurpose purpose = LockPurpose::drive);

  /// Returns one sentence for each ignored holder, such as a user without the right to the lock.
  [[nodiscard]] const std::vector<std::string>& remarks() const noexcept { return remarks_; }

 private:
  [[nodiscard]] tl::expected<void, std::string> add_file(const std::shared_ptr<const RuntimeFolder>& folder,
                                                         const std::string& board, LockPurpose purpose);
  [[nodiscard]] tl::expected<void, std::string> add_name(const std::string& board, LockPurpose purpose);

  std::vector<LockedFile> files_;
  std::vector<Descriptor> names_;
  std::vector<std::string> remarks_;
};

}  // namespace softgrip::daemon
