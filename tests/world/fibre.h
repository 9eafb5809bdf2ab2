#pragma once
// A function with its own stack that runs until it returns control to its caller. All fibres run in one
// thread.

#include <ucontext.h>

#include <csetjmp>
#include <cstddef>
#include <functional>
#include <memory>

namespace softgrip::world {

/// The stack of an abandoned fibre is freed without destroying its objects, like the stack of a killed
/// thread.
class Fibre {
 public:
  explicit Fibre(std::function<void()> body);
  Fibre(const Fibre&) = delete;
  Fibre& operator=(const Fibre&) = delete;
  Fibre(Fibre&&) = delete;
  Fibre& operator=(Fibre&&) = delete;
  ~Fibre() = default;

  /// Continues the body until it calls give_back() or ends. Called from outside the fibre.
  void resume();
  /// Returns control to resume(). Called by the body.
  void give_back();
  [[nodiscard]] bool done() const noexcept { return done_; }

 private:
  static void enter();

  std::function<void()> body_;
  std::unique_ptr<std::byte[]> stack_;
  ucontext_t start_{};
  std::jmp_buf inside_{};
  std::jmp_buf outside_{};
  bool started_ = false;
  bool done_ = false;
};

}  // namespace softgrip::world
