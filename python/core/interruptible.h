#pragma once
// Runs a long computation for Python. A Python callback receives its progress, and a signal such as Ctrl-C
// stops it.

#include <pybind11/pybind11.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>

namespace softgrip::python {

/// Time between two checks for signals.
inline constexpr std::chrono::milliseconds signal_check{50};

/// Calls a Python function from any thread. If the function raises an exception, stores the exception and
/// stops the computation.
class Callback {
 public:
  Callback(pybind11::object function, std::stop_source stop)
      : function_(std::move(function)), stop_(std::move(stop)) {}

  void operator()(const std::string& stage) {
    const pybind11::gil_scoped_acquire gil;
    if (failure_) return;
    try {
      function_(stage);
    } catch (pybind11::error_already_set& error) {
      failure_ = std::make_unique<pybind11::error_already_set>(error);
      stop_.request_stop();
    }
  }
  /// Throws the stored exception of the Python function, if there is one. The caller must hold the global
  /// interpreter lock (GIL).
  void rethrow() {
    if (failure_) throw pybind11::error_already_set(*failure_);
  }

 private:
  pybind11::object function_;
  std::stop_source stop_;
  std::unique_ptr<pybind11::error_already_set> failure_;
};

/// Runs work() in a separate thread without the global interpreter lock (GIL) and returns its result. During
/// this time, the calling thread checks for signals. If Python's signal handler raises an exception (Ctrl-C),
/// the work is stopped and the exception is thrown here.
/// @param progress  a Python function, or None
/// @param options   options of work(); this function sets their `progress` and `stop`
template <class Options, class Work>
auto interruptible(const pybind11::object& progress, Options& options, Work work) {
  using Result = decltype(work());
  std::stop_source stop;
  Callback callback(progress, stop);
  options.stop = stop.get_token();
  if (!progress.is_none()) options.progress = [&callback](const std::string& stage) { callback(stage); };

  std::optional<Result> result;
  std::exception_ptr failure;
  std::mutex mutex;
  std::condition_variable changed;
  bool done = false;
  std::jthread worker([&] {
    try {
      result.emplace(work());
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    done = true;
    changed.notify_one();
  });
  bool interrupted = false;
  {
    const pybind11::gil_scoped_release others_may_run;
    std::unique_lock lock(mutex);
    while (!changed.wait_for(lock, signal_check, [&] { return done; })) {
      lock.unlock();
      if (!interrupted) {
        const pybind11::gil_scoped_acquire gil;
        interrupted = PyErr_CheckSignals() != 0;
        if (interrupted) stop.request_stop();
      }
      lock.lock();
    }
    lock.unlock();
    worker.join();
  }
  options.progress = {};
  if (interrupted) throw pybind11::error_already_set();
  callback.rethrow();
  if (failure) std::rethrow_exception(failure);
  return *std::move(result);
}

}  // namespace softgrip::python
