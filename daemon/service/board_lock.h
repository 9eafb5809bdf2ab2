#pragma once
// Ensures that only one softgrip program drives a board. The program holds a lock until its process ends.
//
// The lock has two parts. The first part is a locked file in the runtime folder, which only root and the
// service can create. The second part is the name of an abstract socket. This name also protects the board if
// the file is removed, and it works between the users of the service's group. Every user of the machine can
// bind such a name. Therefore, the holder of the name is respected only if it is trusted (trusted_user.h).

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

/// The purpose for which a program takes a lock.
enum class LockPurpose : std::uint8_t {
  drive,
  /// Writing the safe outputs. For this purpose, the lock of another running softgrip program is respected.
  /// If a lock cannot be created, the program continues without this lock. A holder that does not run
  /// (stopped, or blocked in a system call) is ignored.
  vent,
};

/// The lock on the boards of a rig. The process holds the lock until the process ends for any reason. The
/// lock excludes other processes of this machine that share /run, and other processes of the network
/// namespace. Another machine that drives the same Modbus TCP board is detected on the network (F304).
class BoardLock {
 public:
  /// Takes the locks of all boards of the rig. If a lock cannot be taken, the error names the program that
  /// holds the lock, or gives another reason.
  [[nodiscard]] static tl::expected<BoardLock, std::string> take(const rig::RigFile& rig,
                                                                 LockPurpose purpose = LockPurpose::drive);

  /// Returns one sentence for each lock that could not be created, and for each holder whose lock was
  /// ignored, for example a user who is not entitled to the lock.
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
