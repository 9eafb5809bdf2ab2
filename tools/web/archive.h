#pragma once
// Reads the recordings from the disk in a separate thread, so that a slow disk does not delay stop and vent
// commands.

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

/// A request to the disk thread.
struct DiskRequest {
  enum class Kind : unsigned char {
    health,   ///< reads the last result of `softgrip health`
    listing,  ///< reads the list of recordings
    file,     ///< opens one file of a recording
    chunk     ///< reads the next bytes of an open file, at most `Archive::chunk_size` bytes
  };
  Kind kind = Kind::listing;
  std::string recording = {};
  std::string name = {};
  std::shared_ptr<const RegularFile> from = nullptr;
};

/// A request to the disk and its answer. The disk thread skips a task if no other object refers to the task.
class DiskTask {
 public:
  explicit DiskTask(DiskRequest disk_request);
  [[nodiscard]] const DiskRequest& request() const noexcept { return request_; }
  /// Returns true if the answer is complete. A complete answer does not change any more.
  [[nodiscard]] bool done() const noexcept { return done_; }
  /// For a health request: returns the last health result; null if there is none.
  [[nodiscard]] const nlohmann::ordered_json& health() const noexcept { return *health_; }
  /// For a list of recordings: returns `{"recordings": [...]}`. For a chunk of a file: returns the bytes, or
  /// "" at the end of the file or after a read error.
  [[nodiscard]] const std::string& text() const noexcept { return *text_; }
  /// For a file: returns the open file; null if the file does not exist or may not be shown.
  [[nodiscard]] const std::shared_ptr<const RegularFile>& file() const noexcept { return file_; }

  // Functions that complete the task; called by the disk thread.
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
  /// Largest number of bytes of a file that are read into memory at once for a download.
  static constexpr std::size_t chunk_size = std::size_t{16} << 10U;
  /// Shortest time between the starts of two lists of recordings. The pause after a list is at least as long
  /// as the creation of this list took, so lists need at most half of the disk thread's time.
  static constexpr std::chrono::milliseconds listing_pause{200};
  /// Longest time for which the destructor waits for the disk thread. A disk call of this thread may block.
  static constexpr std::chrono::milliseconds shutdown_timeout{1000};

  /// Starts the disk thread. An empty `folder` means that there are no recordings.
  explicit Archive(std::string folder);
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
  Archive(Archive&&) = delete;
  Archive& operator=(Archive&&) = delete;
  ~Archive();

  /// Adds a request without waiting. All requests for a list that arrive before the creation of the list
  /// begins get the same list. All other requests are processed before the lists.
  [[nodiscard]] std::shared_ptr<const DiskTask> submit(DiskRequest disk_request);
  /// Returns a descriptor for poll(), which becomes readable when a task is done.
  [[nodiscard]] int descriptor() const noexcept;
  /// Makes the descriptor unreadable until the next task is done. Call this function when the descriptor is
  /// readable.
  void clear_event() const noexcept;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace softgrip::web
