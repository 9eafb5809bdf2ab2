#include "daemon/loop/thread.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <system_error>
#include <utility>

namespace softgrip::daemon {
namespace {

struct Start {
  std::string name;
  std::function<void()> body;
  std::function<void(const std::string&)> on_exception;
};

void* run(void* argument) {
  const std::unique_ptr<Start> start(static_cast<Start*>(argument));
  pthread_setname_np(pthread_self(), start->name.substr(0, 15).c_str());
  try {
    start->body();
  } catch (const std::exception& error) {
    start->on_exception(error.what());
  } catch (...) {
    start->on_exception("an exception of a type other than std::exception");
  }
  return nullptr;
}

}  // namespace

Thread::Thread(const Options& options, std::function<void()> body,
               std::function<void(const std::string&)> on_exception) {
  auto start = std::make_unique<Start>(
      Start{.name = options.name, .body = std::move(body), .on_exception = std::move(on_exception)});
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstacksize(&attributes, options.stack_bytes);
  const int error = pthread_create(&handle_, &attributes, run, start.get());
  pthread_attr_destroy(&attributes);
  if (error != 0) throw std::system_error(error, std::generic_category(), "thread " + options.name);
  static_cast<void>(start.release());  // from here on, the new thread owns the object with the start data
  started_ = true;
}

Thread::Thread(Thread&& other) noexcept
    : handle_(other.handle_), started_(std::exchange(other.started_, false)) {}

Thread& Thread::operator=(Thread&& other) noexcept {
  join();
  handle_ = other.handle_;
  started_ = std::exchange(other.started_, false);
  return *this;
}

Thread::~Thread() {
  join();
}

void Thread::join() noexcept {
  if (!started_) return;
  pthread_join(handle_, nullptr);
  started_ = false;
}

void StopFlag::set() {
  const std::scoped_lock lock(mutex_);
  set_ = true;
  changed_.notify_all();
}

bool StopFlag::wait(std::chrono::duration<double> timeout) {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, timeout, [this] { return set_; });
}

Heartbeat::Heartbeat(const std::vector<Nanoseconds>& patience) {
  for (const Nanoseconds each : patience) counters_.push_back({each, 0, 0});
}

bool Heartbeat::beats(Nanoseconds now, const std::vector<std::uint64_t>& counts) {
  bool all = true;
  for (std::size_t i = 0; i < std::min(counters_.size(), counts.size()); ++i) {
    Counter& counter = counters_[i];
    if (!begun_ || counts[i] != counter.count) counter.grew_at = now;
    counter.count = counts[i];
    all = all && now - counter.grew_at <= counter.patience;
  }
  begun_ = true;
  return all;
}

}  // namespace softgrip::daemon
