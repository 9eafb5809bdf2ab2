#pragma once
// Defines the roles of the clients of the socket API. The socket to which a client is connected determines
// the role of the client.

#include <cstdint>
#include <string_view>

namespace softgrip::daemon {

enum class Role : std::uint8_t {
  look,     ///< read-only; for clients of the socket `socket: look:` of the rig file
  operate,  ///< may move the gripper; for clients of the socket `socket: path:` of the rig file
};
/// Returns the name of a role: "look" or "operate".
[[nodiscard]] constexpr std::string_view name_of(Role role) noexcept {
  return role == Role::look ? "look" : "operate";
}

}  // namespace softgrip::daemon
