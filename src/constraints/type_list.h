// A compile-time list of types, and loops over it.
#pragma once

#include <type_traits>
#include <utility>

namespace pliant {

template <class... Types>
struct TypeList {
  static constexpr int size = sizeof...(Types);
};

namespace detail {
template <class A, class B>
struct Join;
template <class... A, class... B>
struct Join<TypeList<A...>, TypeList<B...>> {
  using Type = TypeList<A..., B...>;
};
}  // namespace detail

/// The types of both lists.
template <class A, class B>
using Joined = typename detail::Join<A, B>::Type;

template <class T>
struct TypeTag {
  using type = T;
};

/// Calls visit(TypeTag<T>{}, index) for every T of the list in order.
template <class... Types, class Visit>
constexpr void for_each_type(TypeList<Types...>, Visit&& visit) {
  int index = 0;
  (visit(TypeTag<Types>{}, index++), ...);
}

/// The index of T in a TypeList.
template <class T, class... Types>
constexpr int index_of(TypeList<Types...> list) {
  int found = -1;
  for_each_type(list, [&](auto tag, int i) { found = std::is_same_v<typename decltype(tag)::type, T> ? i : found; });
  return found;
}

/// Calls visit(TypeTag<T>{}) for the type T at `index`, and for no other.
template <class... Types, class Visit>
constexpr void with_type(TypeList<Types...> list, int index, Visit&& visit) {
  for_each_type(list, [&](auto tag, int i) {
    if (i == index) visit(tag);
  });
}

}  // namespace pliant
