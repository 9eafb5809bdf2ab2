#pragma once
// Defines the permissions of a client of the socket API. They depend on the socket to which the client is
// connected.

#include <cstdint>
#include <string_view>

namespace softgrip::daemon {

enum class Role : std::uint8_t {
  look,     ///< read-only; socket `socket: look:` of the rig file
  operate,  ///< may move the gripper; socket `socket: path:`
};
/// Returns "look" or "operate".
[[nodiscard]] constexpr std::string_view name_of(Role role) noexcept {
  return role == Role::look ? "look" : "operate";
}

}  // namespace softgrip::daemon
