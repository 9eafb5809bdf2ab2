#pragma once
// The folder of one recording. Its file run.csv grows, and its file run.json is complete at any time.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace softgrip::daemon {

/// Returns a sentence with the error if `path` already contains a recording, because a recording is never
/// overwritten. Returns an empty text if a recording may be written to `path`, or if `path` is empty. The
/// caller can call this function to check the folder before any motion.
[[nodiscard]] std::string recorded_already(const std::string& path);

/// Returns a sentence with the error if `path` cannot become the folder of a recording: it is no folder, it
/// cannot be created, or this user may not write into it. Returns an empty text if it can, or if `path` is
/// empty. To test if a folder can be created, this function creates the folder and removes it. The caller can
/// call this function to check the folder before any motion.
[[nodiscard]] std::string why_unrecordable(const std::string& path);

/// Writes a recording and handles errors of the disk. After the first failed write to run.csv, no more rows
/// are written. The file is truncated to its last complete line, and error() gives the reason.
///
/// run.csv reserves space on the disk behind its last line, so that run.json can still be replaced when the
/// disk is full. The size of run.csv does not include this space. Some file systems cannot reserve space; on
/// such a file system, the replacement of run.json can fail on a full disk.
class RunFolder {
 public:
  /// Space that is always reserved for run.json [bytes].
  static constexpr std::size_t least_room = 8192;

  /// Creates `path`, its parent folders, and run.csv with `header`. Refuses a folder that contains a run.csv,
  /// because recordings are never overwritten. If `durable` is true, each new run.json is flushed to the disk
  /// before it is renamed. The error is a sentence. After an error, a folder that this function has created
  /// is removed.
  [[nodiscard]] static tl::expected<RunFolder, std::string> create(const std::string& path,
                                                                   std::string_view header, bool durable);

  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&& other) noexcept;
  ~RunFolder();

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// Passes complete lines to the kernel, so that they are not lost if the process is killed. Returns false
  /// if this write or an earlier one failed. `room` is the space that must remain reserved for run.json
  /// [bytes]. The write fails if the disk has no space for the lines and this room.
  bool append(std::string_view lines, std::size_t room = least_room);
  /// Waits until the appended lines are on the disk. Returns false if the disk reports an error.
  bool sync();
  /// Replaces run.json by a new version in one step. Rows are still recorded after a failure.
  bool replace_json(std::string_view text);
  /// Releases the reserved space. Must be called before the last replace_json(). After a failed append(), the
  /// space is already released.
  void release_room() noexcept;
  /// Returns a sentence about the first disk error of run.csv; empty if there was none.
  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  /// Returns a sentence about the failure of the last replace_json(); empty if it succeeded.
  [[nodiscard]] const std::string& json_error() const noexcept { return json_error_; }
  /// Returns true if rows can still be written, because no write to run.csv has failed.
  [[nodiscard]] bool healthy() const noexcept { return descriptor_ >= 0; }

 private:
  RunFolder(std::string path, int descriptor, bool durable)
      : path_(std::move(path)), descriptor_(descriptor), durable_(durable) {}
  void fail(const std::string& what, int error);
  [[nodiscard]] int reserve(std::int64_t end) noexcept;
  void close() noexcept;

  std::string path_;
  int descriptor_ = -1;
  bool durable_ = true;
  std::int64_t whole_bytes_ = 0;  // size of run.csv after the last successful append
  std::int64_t reserved_bytes_ =
      0;  // space on the disk that run.csv has reserved from its first byte; 0: none
  std::string error_, json_error_;
};

}  // namespace softgrip::daemon
