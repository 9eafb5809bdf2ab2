#include "tools/commissioning/examinations.h"

#include <pwd.h>
#include <sys/statvfs.h>
#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <thread>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/numbers.h"
#include "base/periodic_schedule.h"
#include "daemon/loop/real_time.h"
#include "daemon/loop/statistics.h"
#include "rig/rig_file.h"

namespace softgrip::tools::doctor {
namespace {

using daemon::RealTimeStep;

constexpr double us_per_ns = 1e-3;
constexpr double probe_s = 1;
/// Size of one row of run.csv with its line break [bytes], measured for the rig files in config/.
constexpr double bytes_per_row = 125;
constexpr double s_per_hour = 3600;
constexpr double h_per_day = 24;
constexpr double least_hours = 1;
constexpr double good_hours = 24;

std::string user() {
  const passwd* const entry = ::getpwuid(::geteuid());
  return entry == nullptr ? std::to_string(::geteuid()) : entry->pw_name;
}

/// Adds a finding about one real-time setting of the daemon. A missing setting is a failure if the daemon
/// requires the setting, otherwise a warning.
void take(const RealTimeStep& step, bool required, Findings& findings) {
  switch (step.outcome) {
    case RealTimeStep::Outcome::verified:
      return findings.ok(step.name, step.detail);
    case RealTimeStep::Outcome::not_requested:
      return findings.ok(step.name, "not requested in the rig file");
    case RealTimeStep::Outcome::failed:
      break;
  }
  const std::string who = " (as user " + user() + ")";
  if (required) {
    findings.fail(step.name, step.detail + who,
                  "softgripd will not start, because the rig file sets `real_time: required`. Without this "
                  "setting of the computer, " +
                      step.cost);
  } else {
    findings.warn(step.name, step.detail + who, "grant this real-time setting, or accept that " + step.cost);
  }
}

/// Wakes up once per period of the rig, as the control loop does, and records the wake-up latencies.
void probe_timer(const rig::RigFile& rig, daemon::Histogram& wake_up) {
  const MonotonicClock clock;
  const Nanoseconds period = nanoseconds(1 / rig.settings.rate_hz);
  const Nanoseconds begin = clock.now() + period;
  for (PeriodicSchedule schedule(begin, period); schedule.due() - begin < nanoseconds(probe_s);) {
    const Nanoseconds due = schedule.due();
    sleep_until(due);
    const Nanoseconds woken = clock.now();
    wake_up.add(woken - due);
    schedule.advance(woken);
  }
}

void judge_timer(const rig::RigFile& rig, const daemon::Histogram& wake_up, Findings& findings) {
  timespec resolution{};
  ::clock_getres(CLOCK_BOOTTIME, &resolution);
  const daemon::Histogram::Summary summary = wake_up.summary();
  const double period_us = 1e6 / rig.settings.rate_hz;
  const double p99_us = static_cast<double>(summary.p99_ns) * us_per_ns;
  const double max_us = static_cast<double>(summary.max_ns) * us_per_ns;
  const std::string text =
      fmt::format("{} wake-ups at {:g} Hz: p50 {:.0f} us, p99 {:.0f} us, max {:.0f} us; resolution {} ns",
                  summary.count, rig.settings.rate_hz, static_cast<double>(summary.p50_ns) * us_per_ns,
                  p99_us, max_us, resolution.tv_sec * ns_per_s + resolution.tv_nsec);
  if (resolution.tv_sec > 0 || resolution.tv_nsec > 1000) {
    findings.fail("timer", text, "this kernel has no high-resolution timers (CONFIG_HIGH_RES_TIMERS)");
  } else if (static_cast<double>(wake_up.quantile_ns(0.95)) * us_per_ns > period_us / 2) {
    // One late wake-up per second is tolerable. If one wake-up in 20 is late, the set-up of the computer is
    // faulty.
    findings.fail("timer", text,
                  "the control loop will miss cycles: grant SCHED_FIFO, lower rate_hz, or reduce the load of "
                  "the processor");
  } else if (p99_us > period_us / 10 || max_us > period_us / 2) {
    findings.warn("timer", text,
                  "a wake-up was late by a large part of a cycle: see the findings `kernel` and "
                  "`scheduling of the loop`, and check which other programs run on this computer");
  } else {
    findings.ok("timer", text);
  }
}

/// Returns the path if it exists, otherwise its nearest parent folder that exists.
std::filesystem::path existing(std::filesystem::path path) {
  std::error_code error;
  path = std::filesystem::absolute(path, error);
  while (!std::filesystem::exists(path, error) && path.has_relative_path()) path = path.parent_path();
  return path;
}

/// Writes a file of 4 KiB and synchronises the file to the disk. Returns 0, or the error number (errno).
int try_writing(const std::filesystem::path& folder) {
  std::string path = (folder / ".softgrip-doctor-XXXXXX").string();
  const int file = ::mkstemp(path.data());
  if (file < 0) return errno;
  const std::string bytes(4096, '\0');
  errno = 0;
  const bool written =
      ::write(file, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()) && ::fsync(file) == 0;
  const int error = written ? 0 : (errno == 0 ? ENOSPC : errno);
  ::close(file);
  ::unlink(path.c_str());
  return error;
}

}  // namespace

void examine_machine(const rig::RigFile& rig, Findings& findings) {
  const rig::RealTimeSettings& wanted = rig.real_time;
  const RealTimeStep kernel = daemon::kernel_step();
  if (kernel.detail.find("no PREEMPT_RT") == std::string::npos) {
    findings.ok("kernel", kernel.detail);
  } else {
    findings.warn("kernel", kernel.detail, "install linux-image-rt-amd64 (Debian) and boot this kernel");
  }
  daemon::RealTimeReport report;
  daemon::Histogram wake_up;
  {
    daemon::RealTimeReport process;
    const auto latency = daemon::prepare_process(wanted, process);
    for (std::size_t i = 1; i < process.steps().size(); ++i) report.add(process.steps()[i]);
    std::thread probe([&] {
      daemon::prepare_thread(wanted, wanted.priority, "the loop", report);
      probe_timer(rig, wake_up);
    });
    probe.join();
  }
  for (const RealTimeStep& step : report.steps()) take(step, wanted.required, findings);
  judge_timer(rig, wake_up, findings);
}

void examine_clock(Findings& findings) {
  timex state{};
  const int status = ::adjtimex(&state);
  const std::time_t now = std::time(nullptr);
  std::tm date{};
  ::gmtime_r(&now, &date);
  char text[32] = "";
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &date);
  constexpr int year_of_the_software = 2025;
  if (date.tm_year + 1900 < year_of_the_software) {
    findings.fail("clock", fmt::format("{}: the clock of the computer is wrong", text),
                  "set the clock (timedatectl set-time, or a time server), because recordings and "
                  "calibrations contain its date");
  } else if (status < 0 || status == TIME_ERROR || (state.status & STA_UNSYNC) != 0) {
    findings.warn("clock", fmt::format("{}, not synchronised", text),
                  "recordings may contain a wrong date: install chrony or systemd-timesyncd, or compare the "
                  "clock with a watch. The control uses the monotonic clock and is not affected");
  } else {
    findings.ok("clock", fmt::format("{}, synchronised", text));
  }
}

namespace {

/// Returns a number of hours as text: "12.5 h" up to two days, whole days for a longer time.
std::string in_hours_or_days(double hours) {
  if (hours < 2 * h_per_day) return significant(hours, 3) + " h";
  return fixed(hours / h_per_day, 0) + " days";
}

}  // namespace

void examine_disk(const rig::RigFile& rig, Findings& findings) {
  const rig::RecorderSettings& recorder = rig.recorder;
  if (recorder.mode == rig::RecorderSettings::Mode::off) {
    return findings.ok("disk", "nothing is recorded (recorder: mode: off)");
  }
  const std::filesystem::path folder = existing(recorder.directory);
  std::error_code error;
  const bool there = std::filesystem::exists(recorder.directory, error);
  if (there && !std::filesystem::is_directory(recorder.directory, error)) {
    return findings.fail("disk", recorder.directory + " is no folder", "change recorder: directory");
  }
  if (const int failed = try_writing(folder); failed != 0) {
    return findings.fail(
        "disk",
        fmt::format("{} cannot be written as user {}: {}", recorder.directory, user(), std::strerror(failed)),
        failed == ENOSPC ? "free disk space, or change `directory` under `recorder` in the rig file"
                         : "make the user of softgripd the owner of the folder");
  }
  struct statvfs space {};
  if (::statvfs(folder.c_str(), &space) != 0) {
    return findings.fail("disk", fmt::format("{}: {}", folder.string(), std::strerror(errno)),
                         "change recorder: directory");
  }
  const double free_bytes = static_cast<double>(space.f_bavail) * static_cast<double>(space.f_frsize);
  const double rows_per_s = rig.settings.rate_hz * static_cast<double>(rig.settings.channels.size()) /
                            static_cast<double>(std::max<std::uint32_t>(recorder.decimation, 1));
  const double hours = free_bytes / (rows_per_s * bytes_per_row) / s_per_hour;
  const std::string text = fmt::format("{}: {} GB free, about {} of recording", recorder.directory,
                                       significant(free_bytes * 1e-9, 3), in_hours_or_days(hours));
  if (hours < least_hours) {
    findings.fail(
        "disk", text,
        "free disk space, or change `directory` or raise `decimation` under `recorder` in the rig file");
  } else if (hours < good_hours) {
    findings.warn("disk", text,
                  "the free disk space is enough for less than 1 day of recordings: move old recordings to "
                  "another disk");
  } else {
    findings.ok("disk", text);
  }
}

}  // namespace softgrip::tools::doctor
