// Measures the duration of a whole tick of the control loop's thread. The tick takes readings, controls two
// fingers with full_model and PID, checks limits, runs the supervisor, publishes commands and snapshot, and
// passes rows to the recorder. Only Loop::tick is timed; the simulated board and the recorder run between the
// ticks. Each series of ticks is measured twice. The first measurement uses the CPU time of the thread, which
// excludes interruptions by other threads but needs a system call. The second measurement uses the monotonic
// clock, which is fast to read but includes these interruptions.
//
// After these measurements, the program runs the whole daemon (board, control loop, bus, recorder and disk)
// in virtual time. The program then measures the ratio of simulated time to elapsed time.
//
//   Usage: loop_tick [TICKS]

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/service/daemon_parts.h"
#include "daemon/socket/sequence_loader.h"

namespace {

using namespace softgrip;  // NOLINT(google-build-using-namespace)

constexpr std::uint64_t default_ticks = 400'000;
constexpr std::uint64_t ticks_per_look = 64;

template <class Value>
Value or_exit(std::optional<Value> value, const document::Problems& problems) {
  if (!value) {
    std::fputs(problems.format().c_str(), stderr);
    std::exit(3);
  }
  return std::move(*value);
}

/// Returns the example rig (config/rig.yaml) with the given control rate.
rig::RigFile rig_at(double rate_hz) {
  document::Problems problems;
  document::Document document = document::parse_file(SOFTGRIP_SOURCE_DIR "/config/rig.yaml", problems);
  std::string text = document.text;
  const std::string old = "rate_hz: 200";
  text.replace(text.find(old), old.size(), "rate_hz: " + std::to_string(static_cast<int>(rate_hz)));
  document = document::parse(document.file, text, problems);
  return or_exit(rig::read_rig(document, problems), problems);
}

Nanoseconds read(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return time.tv_sec * ns_per_s + time.tv_nsec;
}

struct Times {
  std::vector<Nanoseconds> sorted;
  [[nodiscard]] long at(double share) const {
    return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
  }
};

/// Measures the time between two successive readings of the clock: the time that a measurement itself takes.
Times time_nothing(clockid_t clock) {
  Times times;
  for (int i = 0; i < 100'000; ++i) {
    const Nanoseconds begin = read(clock);
    times.sorted.push_back(read(clock) - begin);
  }
  std::sort(times.sorted.begin(), times.sorted.end());
  return times;
}

std::shared_ptr<const daemon::LoadedSequence> track_sine(const control::RigSettings& rig) {
  auto sequence =
      daemon::SequenceLoader(rig, "").load_file(SOFTGRIP_SOURCE_DIR "/config/sequences/track_sine.yaml");
  if (!sequence) {
    std::fputs(sequence.error().format().c_str(), stderr);
    std::exit(3);
  }
  return *sequence;
}

/// Measures the ticks of a sequence whose reference is a sine. The sequence is repeated until `ticks` ticks
/// were measured.
Times time_ticks(double rate_hz, clockid_t clock, std::uint64_t ticks) {
  daemon::DaemonOptions options;
  options.virtual_time = true;
  daemon::DaemonParts parts(rig_at(rate_hz), options);
  parts.rig.recorder.mode = rig::RecorderSettings::Mode::off;
  const auto sequence = track_sine(parts.rig.settings);
  Times times;
  times.sorted.reserve(ticks);
  Nanoseconds due = parts.origin;
  for (std::uint64_t tick = 0; times.sorted.size() < ticks; ++tick, due += parts.period()) {
    parts.virtual_clock.set(due);
    const Nanoseconds begin = read(clock);
    parts.loop.tick(due);
    const Nanoseconds took = read(clock) - begin;
    parts.virtual_clock.set(due + parts.bus_offset());
    parts.bus.step(due + parts.bus_offset());
    const control::State state = parts.service.snapshot().state;
    if (state == control::State::running) times.sorted.push_back(took);
    if (tick % ticks_per_look != 0) continue;
    parts.service.pump();
    parts.recorder.drain();
    if (state == control::State::idle) parts.service.submit(control::Request::Kind::start, sequence);
  }
  std::sort(times.sorted.begin(), times.sorted.end());
  return times;
}

void print(double rate_hz, const char* name, clockid_t clock, std::uint64_t ticks) {
  const Times nothing = time_nothing(clock);
  const Times times = time_ticks(rate_hz, clock, ticks);
  std::printf(
      "%4.0f Hz  %-14s  p50 %6ld  p99 %6ld  p99.9 %6ld  max %8ld  (time to read the clock, included: p50 "
      "%ld)\n",
      rate_hz, name, times.at(0.5), times.at(0.99), times.at(0.999), times.at(1), nothing.at(0.5));
}

/// Prints the number of seconds of rig time that the daemon simulates and records per second of elapsed time
/// and per second of processor time. Each result is the median of several repetitions, with the smallest and
/// the largest value.
void print_speed(double rate_hz) {
  constexpr int runs = 7;
  std::vector<double> by_clock;
  std::vector<double> by_processor;
  std::uint64_t bytes = 0;
  for (int i = 0; i < runs; ++i) {
    std::string folder = (std::filesystem::temp_directory_path() / "loop_tick-XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) std::exit(4);
    rig::RigFile rig = rig_at(rate_hz);
    daemon::DaemonOptions options;
    options.virtual_time = true;
    options.sequence = track_sine(rig.settings);
    options.record_folder = folder;
    const auto daemon = daemon::Daemon::create(std::move(rig), options);
    const Nanoseconds begin = read(CLOCK_PROCESS_CPUTIME_ID);
    const daemon::Outcome outcome = (*daemon)->run();
    const double rig_s = static_cast<double>(outcome.ticks) / rate_hz;
    by_clock.push_back(rig_s / outcome.wall_s);
    by_processor.push_back(rig_s / seconds(read(CLOCK_PROCESS_CPUTIME_ID) - begin));
    bytes = std::filesystem::file_size(folder + "/run.csv");
    std::filesystem::remove_all(folder);
  }
  std::printf("%4.0f Hz  simulation in virtual time; each run records a file of %lu MB; %d runs\n", rate_hz,
              static_cast<unsigned long>(bytes >> 20), runs);
  for (auto [name, factors] : {std::pair{"clock", by_clock}, std::pair{"processor time", by_processor}}) {
    std::sort(factors.begin(), factors.end());
    std::printf("         by %-14s %5.0f times faster than real time (median; range %.0f to %.0f)\n", name,
                factors[runs / 2], factors.front(), factors.back());
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t ticks = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : default_ticks;
  std::printf("one tick, two fingers, ns, %lu ticks each\n", static_cast<unsigned long>(ticks));
  for (const double rate_hz : {200.0, 1000.0}) {
    print(rate_hz, "processor time", CLOCK_THREAD_CPUTIME_ID, ticks);
    print(rate_hz, "clock", CLOCK_MONOTONIC, ticks);
  }
  print_speed(1000);
  return 0;
}
