#include "tools/web/archive.h"

#include <sys/eventfd.h>

#include <algorithm>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <utility>

#include <nlohmann/json.hpp>

#include "base/clock.h"
#include "base/json.h"
#include "tools/client/daemon_text.h"

namespace softgrip::web {

namespace {

using Json = nlohmann::ordered_json;
using SteadyClock = std::chrono::steady_clock;

}  // namespace

DiskTask::DiskTask(DiskRequest disk_request)
    : request_(std::move(disk_request)),
      health_(std::make_shared<const Json>()),
      text_(std::make_shared<const std::string>()) {}

void DiskTask::answer_health(const Json& health) {
  health_ = std::make_shared<const Json>(health);
  done_ = true;
}

void DiskTask::answer_text(std::shared_ptr<const std::string> text) {
  text_ = std::move(text);
  done_ = true;
}

void DiskTask::answer_file(std::shared_ptr<const RegularFile> file) {
  file_ = std::move(file);
  done_ = true;
}

/// Data that the archive shares with its disk thread. Both own the data, because the thread may exist longer
/// than the archive if a disk call blocks.
struct Archive::Shared {
  using DiskTasks = std::deque<std::shared_ptr<DiskTask>>;

  explicit Shared(std::string folder) : recordings(std::move(folder)) {}

  void work();
  void run_quick_tasks();
  void list(const DiskTasks& tasks);
  void answer(DiskTask& task) const;
  void notify() const noexcept;
  [[nodiscard]] DiskTasks take_quick_tasks();

  Descriptor done_event{::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)};
  Recordings recordings;  // used by the disk thread and by no other thread
  std::mutex mutex;
  std::condition_variable changed;
  DiskTasks quick;     // waiting tasks of all kinds except lists of recordings
  DiskTasks listings;  // waiting tasks for lists of recordings
  bool stop_requested = false;
  bool stopped = false;
};

void Archive::Shared::work() {
  SteadyClock::time_point next_listing = SteadyClock::now();
  std::unique_lock lock(mutex);
  while (!stop_requested) {
    if (!quick.empty()) {
      lock.unlock();
      run_quick_tasks();
      lock.lock();
    } else if (listings.empty()) {
      changed.wait(lock);
    } else if (SteadyClock::now() < next_listing) {
      changed.wait_until(lock, next_listing);
    } else {
      const DiskTasks tasks = std::exchange(listings, {});
      const SteadyClock::time_point began = SteadyClock::now();
      lock.unlock();
      list(tasks);
      lock.lock();
      next_listing = began + std::max<SteadyClock::duration>(listing_pause, 2 * (SteadyClock::now() - began));
    }
  }
  stopped = true;
  changed.notify_all();
}

Archive::Shared::DiskTasks Archive::Shared::take_quick_tasks() {
  const std::lock_guard lock(mutex);
  return std::exchange(quick, {});
}

void Archive::Shared::run_quick_tasks() {
  for (const std::shared_ptr<DiskTask>& task : take_quick_tasks()) {
    if (task.use_count() == 1)
      continue;  // no object waits for the answer of this task, so the task is
                 // skipped
    answer(*task);
    notify();
  }
}

void Archive::Shared::answer(DiskTask& task) const try {
  const DiskRequest& disk_request = task.request();
  if (disk_request.kind == DiskRequest::Kind::health) {
    task.answer_health(tools::last_health(recordings.folder()));
  } else if (disk_request.kind == DiskRequest::Kind::chunk) {
    const auto bytes = read_start(*disk_request.from, chunk_size);
    task.answer_text(std::make_shared<const std::string>(bytes.value_or(std::string())));
  } else {
    auto opened = recordings.open(disk_request.recording, disk_request.name);
    task.answer_file(opened ? std::make_shared<const RegularFile>(std::move(*opened)) : nullptr);
  }
} catch (const std::exception&) {
  task.fail();
}

void Archive::Shared::list(const DiskTasks& tasks) {
  if (std::all_of(tasks.begin(), tasks.end(), [](const auto& task) { return task.use_count() == 1; })) return;
  const Json list = recordings.list(wall_time_now(), [this] { run_quick_tasks(); });
  const auto text = std::make_shared<const std::string>(json_dump(Json{{"recordings", list}}));
  for (const std::shared_ptr<DiskTask>& task : tasks) task->answer_text(text);
  notify();
}

void Archive::Shared::notify() const noexcept {
  // The write fails if the counter is full, and for no other reason. The descriptor is then already readable,
  // which is the purpose of the write.
  [[maybe_unused]] const int result = ::eventfd_write(done_event.get(), 1);
}

Archive::Archive(std::string folder)
    : shared_(std::make_shared<Shared>(std::move(folder))), thread_([shared = shared_] { shared->work(); }) {}

Archive::~Archive() {
  std::unique_lock lock(shared_->mutex);
  shared_->stop_requested = true;
  shared_->changed.notify_all();
  const bool stopped = shared_->changed.wait_for(lock, shutdown_timeout, [this] { return shared_->stopped; });
  lock.unlock();
  if (stopped) {
    thread_.join();
  } else {
    thread_.detach();
  }
}

std::shared_ptr<const DiskTask> Archive::submit(DiskRequest disk_request) {
  auto task = std::make_shared<DiskTask>(std::move(disk_request));
  const std::lock_guard lock(shared_->mutex);
  (task->request().kind == DiskRequest::Kind::listing ? shared_->listings : shared_->quick).push_back(task);
  shared_->changed.notify_all();
  return task;
}

int Archive::descriptor() const noexcept {
  return shared_->done_event.get();
}

void Archive::clear_event() const noexcept {
  eventfd_t count = 0;
  [[maybe_unused]] const int result = ::eventfd_read(shared_->done_event.get(), &count);
}

}  // namespace softgrip::web
