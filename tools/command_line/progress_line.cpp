#include "tools/command_line/progress_line.h"

#include <unistd.h>

#include <csignal>
#include <optional>
#include <string_view>
#include <utility>

#include "base/numbers.h"

namespace softgrip::tools {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// Returns the two numbers of the first phrase such as "3 of 20" in a text; nullopt if the text has no such
/// phrase.
std::optional<std::pair<std::size_t, std::size_t>> share_in(std::string_view text) {
  constexpr std::string_view between = " of ";
  for (std::size_t at = text.find(between); at != std::string_view::npos; at = text.find(between, at + 1)) {
    std::size_t from = at;
    while (from > 0 && is_digit(text[from - 1])) --from;
    std::size_t to = at + between.size();
    while (to < text.size() && is_digit(text[to])) ++to;
    const auto done = to_number(text.substr(from, at - from));
    const auto whole = to_number(text.substr(at + between.size(), to - at - between.size()));
    if (done && whole) return std::pair{static_cast<std::size_t>(*done), static_cast<std::size_t>(*whole)};
  }
  return std::nullopt;
}

std::string seconds_text(double seconds) {
  constexpr double short_enough = 600;
  if (seconds < short_enough) return fixed(seconds, 0) + " s";
  return fixed(seconds / 60, 0) + " min";
}

}  // namespace

double RestEstimate::left_s(const std::string& text, double now_s) {
  const auto share = share_in(text);
  if (!share || share->second != whole_ || share->first < first_) {
    whole_ = share ? share->second : 0;
    first_ = share ? share->first : 0;
    began_s_ = now_s;
    return -1;
  }
  const std::size_t done = share->first - first_;
  if (done == 0 || share->first > whole_) return -1;
  return (now_s - began_s_) * static_cast<double>(whole_ - share->first) / static_cast<double>(done);
}

ProgressLine::ProgressLine(std::FILE* to, std::chrono::milliseconds every)
    : to_(to), every_(every), terminal_(::isatty(::fileno(to)) == 1) {
  // The thread that shows the progress blocks all signals, so that the main thread receives them.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  repeater_ = std::thread([this] { repeat(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

ProgressLine::~ProgressLine() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  over_.notify_all();
  repeater_.join();
  if (terminal_ && !text_.empty()) std::fputs("\r\033[K", to_);
  std::fflush(to_);
}

std::function<void(const std::string&)> ProgressLine::show() {
  return [this](const std::string& text) { say(text); };
}

std::string ProgressLine::latest() const {
  const double now_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
  std::string line = seconds_text(now_s) + ": " + text_;
  // Subtract the time that has passed since the estimate of the remaining time. A remaining time below 1 s is
  // not shown.
  const double rest_s = left_s_ - (now_s - said_s_);
  if (rest_s >= 1) line += ", about " + seconds_text(rest_s) + " left";
  return line;
}

void ProgressLine::say(const std::string& text) {
  const std::lock_guard lock(mutex_);
  said_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
  left_s_ = estimate_.left_s(text, said_s_);
  text_ = text;
  if (!terminal_) return;
  std::fputs("\r\033[K", to_);
  if (!text.empty()) std::fprintf(to_, "  %s ", latest().c_str());
  std::fflush(to_);
}

void ProgressLine::repeat() {
  std::unique_lock lock(mutex_);
  while (!over_.wait_for(lock, terminal_ ? std::chrono::seconds(1) : every_, [this] { return ended_; })) {
    if (text_.empty()) continue;
    std::fprintf(to_, terminal_ ? "\r\033[K  %s " : "  %s\n", latest().c_str());
    std::fflush(to_);
  }
}

}  // namespace softgrip::tools
