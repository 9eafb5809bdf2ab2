#pragma once
// Defines the permissions of a client of the socket API. The socket to which the client is connected
// determines them.

#include <cstdint>
#include <string_view>

namespace softgrip::daemon {

enum class Role : std::uint8_t {
  look,     ///< read-only; for the socket that the rig file gives as `socket: look:`
  operate,  ///< may move the gripper; for the socket that the rig file gives as `socket: path:`
};
/// Returns the name of a role: "look" or "operate".
[[nodiscard]] constexpr std::string_view name_of(Role role) noexcept {
  return role == Role::look ? "look" : "operate";
}

}  // namespace softgrip::daemon
