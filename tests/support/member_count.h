#pragma once
#include <cstddef>
#include <type_traits>
#include <utility>

namespace asdic::detail::support {

/// Becomes whatever a member needs.
struct Anything {
  std::size_t which;
  template <class T>
  operator T() const;  // NOLINT: never defined, only asked for
};

template <class T, std::size_t... I>
consteval bool takes(std::index_sequence<I...>) {
  return requires { T{Anything{I}...}; };
}

/// How many members an aggregate has: the largest number of values in braces that it takes.
template <class T, std::size_t n = 0>
consteval int member_count() {
  static_assert(std::is_aggregate_v<T>);
  if constexpr (takes<T>(std::make_index_sequence<n + 1>{})) return member_count<T, n + 1>();
  return static_cast<int>(n);
}

}  // namespace asdic::detail::support
