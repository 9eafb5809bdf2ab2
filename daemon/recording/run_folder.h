#pragma once
// The folder of one recorded run on disk: run.csv, which grows, and run.json, which is whole at any moment.

#include <cstdint>
#include <string>
#include <string_view>

#include <tl/expected.hpp>

namespace softgrip::daemon {

/// Returns a sentence if `path` already holds a recording, because a recording is never overwritten. Returns
/// an empty string if a run may be recorded there, or if `path` is empty. It permits a check before any
/// motion.
[[nodiscard]] std::string recorded_already(const std::string& path);

/// Writes, and survives what disks do. After the first failed write of run.csv it writes no more rows: the
/// file is cut back to its last whole line and error() says why.
class RunFolder {
 public:
  /// Creates `path` and the folders above it, and run.csv with `header` in it. Refuses a folder that already
  /// holds a run.csv: recordings are never overwritten. `durable`: run.json is on the disk, not only in the
  /// kernel, before it takes its name. The error is a sentence.
  [[nodiscard]] static tl::expected<RunFolder, std::string> create(const std::string& path,
                                                                   std::string_view header, bool durable);

  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;
  RunFolder(RunFolder&& other) noexcept;
  RunFolder& operator=(RunFolder&& other) noexcept;
  ~RunFolder();

  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// Hands whole lines to the kernel: what a kill of the process cannot take back. False once it has failed.
  bool append(std::string_view lines);
  /// Waits until the disk has what append() was given.
  bool sync();
  /// Replaces run.json atomically. A failure is reported but does not end the recording of rows.
  bool replace_json(std::string_view text);
  /// Empty, or the sentence of the first failure.
  [[nodiscard]] const std::string& error() const noexcept { return error_; }
  /// True if rows can still be written.
  [[nodiscard]] bool healthy() const noexcept { return descriptor_ >= 0; }

 private:
  RunFolder(std::string path, int descriptor, bool durable)
      : path_(std::move(path)), descriptor_(descriptor), durable_(durable) {}
  void fail(const std::string& what, int error);
  void close() noexcept;

  std::string path_;
  int descriptor_ = -1;
  bool durable_ = true;
  std::int64_t whole_bytes_ = 0;  // of run.csv, up to the end of the last append that succeeded
  std::string error_;
};

}  // namespace softgrip::daemon
