#include "tests/world/fibre.h"

#include <cstdint>
#include <utility>

namespace softgrip::world {
namespace {

constexpr std::size_t stack_bytes = 512 * 1024;

}  // namespace

Fibre::Fibre(std::function<void()> body)
    : body_(std::move(body)), stack_(std::make_unique_for_overwrite<std::byte[]>(stack_bytes)) {
  getcontext(&own_);
  own_.uc_stack.ss_sp = stack_.get();
  own_.uc_stack.ss_size = stack_bytes;
  own_.uc_link = nullptr;
  const auto self = reinterpret_cast<std::uintptr_t>(this);
  // makecontext() passes numbers of the size of int only.
  makecontext(&own_, reinterpret_cast<void (*)()>(&Fibre::enter), 2, static_cast<unsigned>(self >> 32U),
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
  swapcontext(&outside_, &own_);
}

void Fibre::give_back() {
  swapcontext(&own_, &outside_);
}

}  // namespace softgrip::world
