#pragma once

#include <utility>
#include <variant>

namespace tubecut {

/// std::variant for alternatives that are strings, vectors or plain. It is needed because libstdc++
/// 12 destroys an alternative that it has not constructed when memory ends while it copies one of
/// them.
template <class... Types>
struct Variant : std::variant<Types...> {
  using Base = std::variant<Types...>;
  using Base::Base;
  Variant() = default;
  Variant(const Variant& other) : Base() {
    std::visit(
        [this](const auto& value) {
          auto copy = value;  // this may throw, the next line does not
          static_cast<Base&>(*this) = std::move(copy);
        },
        static_cast<const Base&>(other));
  }
  Variant(Variant&&) = default;
  Variant& operator=(const Variant& other) {
    Variant copy(other);
    static_cast<Base&>(*this) = static_cast<Base&&>(copy);
    return *this;
  }
  Variant& operator=(Variant&&) = default;
  ~Variant() = default;

  using Base::operator=;
};

}  // namespace tubecut
