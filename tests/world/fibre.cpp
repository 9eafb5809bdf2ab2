// swapcontext() asks the kernel for the signal mask at every change of stacks, which was two fifths of a
// world's time: here it is setcontext() for the first entry only, and then a way that goes without, as in
// QEMU's coroutines.
#include "tests/world/fibre.h"

#include <cstdint>
#include <utility>

namespace softgrip::world {
namespace {

constexpr std::size_t stack_bytes = 512 * 1024;

}  // namespace

Fibre::Fibre(std::function<void()> body)
    : body_(std::move(body)), stack_(std::make_unique_for_overwrite<std::byte[]>(stack_bytes)) {
  getcontext(&start_);
  start_.uc_stack.ss_sp = stack_.get();
  start_.uc_stack.ss_size = stack_bytes;
  start_.uc_link = nullptr;
  const auto self = reinterpret_cast<std::uintptr_t>(this);
  // makecontext() passes numbers of the size of int only.
  makecontext(&start_, reinterpret_cast<void (*)()>(&Fibre::enter), 2, static_cast<unsigned>(self >> 32U),
              static_cast<unsigned>(self & 0xffffffffU));
}

void Fibre::enter(unsigned high, unsigned low) {
  const auto self = (static_cast<std::uintptr_t>(high) << 32U) | low;
  auto* fibre = reinterpret_cast<Fibre*>(self);
  fibre->body_();
  fibre->done_ = true;
  for (;;) fibre->give_back();
}

void Fibre::resume() {
  if (_setjmp(outside_) != 0) return;
  if (started_) _longjmp(inside_, 1);
  started_ = true;
  setcontext(&start_);
}

void Fibre::give_back() {
  if (_setjmp(inside_) == 0) _longjmp(outside_, 1);
}

}  // namespace softgrip::world
