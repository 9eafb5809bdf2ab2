#pragma once
// Reads the recordings from the disk in a separate thread, so that a slow disk delays no stop or vent
// command.

#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <thread>

#include <nlohmann/json_fwd.hpp>

#include "base/files.h"
#include "tools/web/recordings.h"

namespace softgrip::web {

/// A request to the disk.
struct DiskRequest {
  enum class Kind : unsigned char {
    health,   ///< the last result of `softgrip health`
    listing,  ///< the list of recordings
    file,     ///< a file of a recording, to be opened
    piece     ///< the next bytes of an open file, `Archive::piece` at most
  };
  Kind kind = Kind::listing;
  std::string recording = {};
  std::string name = {};
  std::shared_ptr<const RegularFile> from = nullptr;
};

/// A request and its answer. The thread skips a task that its owner has dropped.
class DiskTask {
 public:
  explicit DiskTask(DiskRequest disk_request);
  [[nodiscard]] const DiskRequest& request() const noexcept { return request_; }
  /// Returns true if the answer is complete. It does not change any more.
  [[nodiscard]] bool done() const noexcept { return done_; }
  /// For a health request: the result, or null if there is none.
  [[nodiscard]] const nlohmann::ordered_json& health() const noexcept { return *health_; }
  /// For a listing: `{"recordings": [...]}`. For a piece: the bytes, or "" at the end of the file or after a
  /// read error.
  [[nodiscard]] const std::string& text() const noexcept { return *text_; }
  /// For a file request: the open file, or null if no such file may be shown.
  [[nodiscard]] const std::shared_ptr<const RegularFile>& file() const noexcept { return file_; }

  // Called by the disk thread.
  void answer_health(const nlohmann::ordered_json& health);
  void answer_text(std::shared_ptr<const std::string> text);
  void answer_file(std::shared_ptr<const RegularFile> file);
  /// Completes the task without a result.
  void fail() noexcept { done_ = true; }

 private:
  DiskRequest request_;
  std::shared_ptr<const nlohmann::ordered_json> health_;
  std::shared_ptr<const std::string> text_;
  std::shared_ptr<const RegularFile> file_;
  std::atomic<bool> done_ = false;
};

class Archive {
 public:
  /// Bytes of one download that are kept in memory.
  static constexpr std::size_t piece = std::size_t{16} << 10U;
  /// Smallest time between the beginnings of two lists. The pause is at least as long as the last list took,
  /// so that lists use at most half of the thread's time.
  static constexpr std::chrono::milliseconds listing_pause{200};
  /// The longest time that the destructor waits for a disk that does not respond.
  static constexpr std::chrono::milliseconds farewell{1000};

  /// An empty `folder` means that there are no recordings.
  explicit Archive(std::string folder);
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
  Archive(Archive&&) = delete;
  Archive& operator=(Archive&&) = delete;
  ~Archive();

  /// Adds a request without waiting. One list serves all list requests that arrive before it begins. All
  /// other requests have priority over lists.
  [[nodiscard]] std::shared_ptr<const DiskTask> ask(DiskRequest disk_request);
  /// For poll(): readable when a task is done.
  [[nodiscard]] int descriptor() const noexcept;
  /// Resets the descriptor. Call it when the descriptor is readable.
  void hear() const noexcept;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace softgrip::web
