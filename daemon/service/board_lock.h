#pragma once
// One Modbus client per board that writes: a program that drives a board holds a lock, which ends with the
// process.
//
// The lock has two halves. A locked file in the runtime folder: only root and the service can make it. And a
// name of an abstract socket: it works also after the removal of the file, and between the users of the
// service's group. Every user of the machine can bind such a name, so a holder counts only if it is trusted
// (trusted_user.h).

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <tl/expected.hpp>

#include "base/descriptor.h"
#include "daemon/service/runtime_folder.h"
#include "rig/rig_file.h"

namespace softgrip::daemon {

/// Returns the devices that a rig drives: "modbus 192.168.1.5 port 502 unit 1", a serial device or a
/// converter by its real path; one entry each. The list is empty for a simulated board.
[[nodiscard]] std::vector<std::string> driven_by(const rig::RigFile& rig);

/// A file of the runtime folder that this process has locked. Its end removes the file.
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
  /// Safe outputs: they yield to another program of softgrip that runs. A lock that cannot be made, and a
  /// holder that stands still (stopped, or hung in a system call), do not keep them from the board.
  vent,
};

/// Held by this process until it ends, however it ends. It binds the processes of one machine: those that
/// share /run, and those of one network namespace. Another machine on the same Modbus TCP board is noticed on
/// the wire instead (F304).
class BoardLock {
 public:
  /// Takes all that the rig drives. The error names the program that has it, or the reason.
  [[nodiscard]] static tl::expected<BoardLock, std::string> take(const rig::RigFile& rig,
                                                                 LockPurpose purpose = LockPurpose::drive);

  /// Returns one sentence for each holder that did not count, such as a user without the right to the lock.
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
