#pragma once
// Runs a function on a stack of its own. The function can return control to its caller before its end and
// continue later. All fibres run in the same thread.

#include <ucontext.h>

#include <csetjmp>
#include <cstddef>
#include <functional>
#include <memory>

namespace softgrip::world {

/// A function with a stack of its own. If the function has not ended, the destructor frees the stack. It does
/// not destroy the objects on the stack, as if a thread had been killed.
class Fibre {
 public:
  explicit Fibre(std::function<void()> body);
  Fibre(const Fibre&) = delete;
  Fibre& operator=(const Fibre&) = delete;
  Fibre(Fibre&&) = delete;
  Fibre& operator=(Fibre&&) = delete;
  ~Fibre() = default;

  /// Continues the function until it calls give_back() or ends. Called from outside the fibre.
  void resume();
  /// Returns control to the caller of resume(). Called by the function of the fibre.
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
