#pragma once

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

namespace tubecut {

/// A value and its name on the wire.
template <class E>
struct Option {
  std::string_view name;
  E value;
};

/// The names of all values of an enumeration, in the order in which they are offered. The api's
/// `Reader::choice` reads them, `name_of` writes them. They are defined in the api's header of the
/// module, such as api/wire/joint_names.hpp, or next to the enumeration if core's paths and
/// messages use them too.
template <class E>
inline constexpr auto kNames = nullptr;

template <class E>
concept Named = requires {
  kNames<E>.size();
};

template <Named E>
[[nodiscard]] constexpr std::string_view name_of(E value) {
  for (const auto& [name, one] : kNames<E>)
    if (one == value) return name;
  throw std::logic_error("a value without a name");
}

/// Returns the first of a list, if not all values are offered.
template <std::size_t Count, class E, std::size_t N>
[[nodiscard]] constexpr std::array<Option<E>, Count> first(const std::array<Option<E>, N>& all) {
  std::array<Option<E>, Count> out{};
  std::copy_n(all.begin(), Count, out.begin());
  return out;
}
/// These values of one enumeration, if not all are offered.
template <auto First, decltype(First)... Others>
inline constexpr std::array kOnly{Option<decltype(First)>{name_of(First), First},
                                  Option<decltype(First)>{name_of(Others), Others}...};

}  // namespace tubecut
