#pragma once
// The recordings' disk, in a thread of its own: a slow or dead disk delays neither a stop nor a vent.

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
  /// health: null where there is none.
  [[nodiscard]] const nlohmann::ordered_json& health() const noexcept { return *health_; }
  /// listing: `{"recordings": [...]}`; piece: the bytes, empty if there are none or they cannot be read.
  [[nodiscard]] const std::string& text() const noexcept { return *text_; }
  /// file: null where there is none that may be shown.
  [[nodiscard]] const std::shared_ptr<const RegularFile>& file() const noexcept { return file_; }

  // For the thread of the disk.
  void answer_health(const nlohmann::ordered_json& health);
  void answer_text(std::shared_ptr<const std::string> text);
  void answer_file(std::shared_ptr<const RegularFile> file);
  /// The answer is that there is none.
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
  /// Bytes of one download that are in memory.
  static constexpr std::size_t piece = std::size_t{16} << 10U;
  /// From the begin of a list to the begin of the next one, and at least as long as the list took: however
  /// many viewers ask, half of the thread's time is left to others.
  static constexpr std::chrono::milliseconds listing_pause{200};
  /// The longest time that the destructor waits for a disk that does not answer.
  static constexpr std::chrono::milliseconds farewell{1000};

  /// `folder` may be empty: then there are no recordings.
  explicit Archive(std::string folder);
  Archive(const Archive&) = delete;
  Archive& operator=(const Archive&) = delete;
  Archive(Archive&&) = delete;
  Archive& operator=(Archive&&) = delete;
  ~Archive();

  /// Never waits. A list begins after its request, and serves all requests of the meantime. All other
  /// requests come before it.
  [[nodiscard]] std::shared_ptr<const DiskTask> ask(DiskRequest disk_request);
  /// For poll(): readable when a task is done.
  [[nodiscard]] int descriptor() const noexcept;
  /// To be called when it is readable.
  void hear() const noexcept;

 private:
  struct Shared;
  std::shared_ptr<Shared> shared_;
  std::thread thread_;
};

}  // namespace softgrip::web
