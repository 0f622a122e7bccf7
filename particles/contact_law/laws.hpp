#pragma once
// The laws of one contact on numbers. The law of a problem is a type (contact_laws-inl.h), chosen once per solve:
// a scene without friction never meets a branch about it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "particles/contact_law/contact_laws-inl.h"

namespace drumlin::particles {

namespace contact_law {

// Operations on numbers. A NaN in the last argument, or in the first of clamped(), stays one.
template <class N>
N number(double value) {
  return static_cast<N>(value);
}
template <class N>
bool any(bool is, N) {
  return is;
}
inline bool both(bool a, bool b) { return a && b; }
inline bool either(bool a, bool b) { return a || b; }
template <class N>
bool greater(N a, N b) {
  return a > b;
}
template <class N>
bool not_less(N a, N b) {
  return a >= b;
}
template <class N>
bool not_greater(N a, N b) {
  return a <= b;
}
template <class N>
N where(bool is, N a, N b) {
  return is ? a : b;
}
template <class N>
N absolute(N a) {
  return std::abs(a);
}
template <class N>
N square_root(N a) {
  return std::sqrt(a);
}
template <class N>
N with_sign_of(N size, N sign) {
  return std::copysign(size, sign);
}
template <class N>
N positive_part(N a) {
  return a < 0 ? N(0) : a;
}
template <class N>
N larger(N a, N b) {
  return b <= a ? a : b;
}
template <class N>
N smaller(N a, N b) {
  return a <= b ? a : b;
}
template <class N>
N clamped(N a, N bound) {
  return std::clamp(a, -bound, bound);
}

#define CONTACT_LAW [[gnu::always_inline]] inline
#include "particles/contact_law/law_text-inl.h"
#undef CONTACT_LAW

/// The dim numbers at a position of an array.
template <std::size_t dim>
std::array<double, dim> numbers_at(const double* place) {
  std::array<double, dim> numbers;
  std::copy_n(place, dim, numbers.begin());
  return numbers;
}

}  // namespace contact_law
}  // namespace drumlin::particles
