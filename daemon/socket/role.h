#pragma once
// Defines the permissions of a client of the socket API, by the socket of its connection.

#include <cstdint>
#include <string_view>

namespace softgrip::daemon {

enum class Role : std::uint8_t {
  look,     ///< `socket: look:` of the rig file
  operate,  ///< `socket: path:`
};
/// Returns "look" or "operate".
[[nodiscard]] constexpr std::string_view name_of(Role role) noexcept {
  return role == Role::look ? "look" : "operate";
}

}  // namespace softgrip::daemon
