// swapcontext() sets the signal mask of the kernel at every switch between fibres. The system calls for the
// signal masks took 40 % of the processor time of a simulation. Therefore setcontext() is used only for the
// first entry into a fibre. Later switches use _setjmp() and _longjmp(), as the coroutines of QEMU do.
#include "tests/world/fibre.h"

#include <utility>

namespace softgrip::world {
namespace {

constexpr std::size_t stack_bytes = 512 * 1024;
/// Fibre whose first entry is in progress. This is a global variable, because makecontext() passes no pointer
/// to the function of the fibre.
thread_local Fibre* entered = nullptr;

}  // namespace

Fibre::Fibre(std::function<void()> body)
    : body_(std::move(body)), stack_(std::make_unique_for_overwrite<std::byte[]>(stack_bytes)) {
  getcontext(&start_);
  start_.uc_stack.ss_sp = stack_.get();
  start_.uc_stack.ss_size = stack_bytes;
  start_.uc_link = nullptr;
  makecontext(&start_, &Fibre::enter, 0);
}

void Fibre::enter() {
  Fibre& fibre = *entered;
  fibre.body_();
  fibre.done_ = true;
  for (;;) fibre.give_back();
}

void Fibre::resume() {
  if (_setjmp(outside_) != 0) return;
  if (started_) _longjmp(inside_, 1);
  started_ = true;
  entered = this;
  setcontext(&start_);
}

void Fibre::give_back() {
  if (_setjmp(inside_) == 0) _longjmp(outside_, 1);
}

}  // namespace softgrip::world
