#pragma once
// Models a stiffness that increases beyond a position: contact with an object or an end stop.

#include "model/block.h"
#include "model/static_map.h"

namespace softgrip::model {

/// Computes the displacement z of a finger with contact from the free displacement y. z = y up to the
/// position of the contact. Beyond this position, the additional motion is divided by 1 + stiffening.
template <class T>
class Contact : public StaticMapBlock<Contact<T>, T> {
 public:
  static constexpr bool at_samples = true;
  static constexpr BlockInfo info = block_info(
      "contact", Station::load, Kind::displacement, Inverse::implicit, "Contact",
      "Beyond a contact position, the finger is stiffer than in free motion, because it touches an object or "
      "a stop.",
      "z = y up to the position, beyond it position + (y - position)/(1 + stiffening)", Repeatable{});
  static constexpr std::array parameters{
      parameter("position_mm", "mm", "displacement at which contact begins", Typical{15.0},
                Within{-1000.0, 1000.0}, Scale{2.0}),
      parameter("stiffening", "",
                "stiffness of the contact, divided by the stiffness of the actuator in free motion; the "
                "value 1 halves the motion beyond the contact position",
                Typical{1.0}, Within{0.0, 1e6}, Scale{0.5}, Neutral{0.0})};

  Contact(std::span<const T> values, const Preparation&)
      : position_mm_(values[0]), beyond_(1.0 / (1.0 + values[1])) {}

  [[nodiscard]] const T& position_mm() const { return position_mm_; }

  template <class U>
  [[nodiscard]] U map(const U& y) const {
    return value_of(y) > value_of(position_mm_) ? U(position_mm_ + (y - position_mm_) * beyond_) : y;
  }

 private:
  T position_mm_;
  T beyond_;
};

}  // namespace softgrip::model
