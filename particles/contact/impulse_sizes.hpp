#pragma once
// Sizes of the impulses that gave bodies at rest their velocities: one by one and on vectors, the same
// numbers.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

namespace drumlin::particles {

/// Size of the impulse that gave a body at rest its velocity; 0 of what does not move.
template <class Body>
double impulse_of(const Body& body) {
  if (!(body.inverse_mass > 0)) return 0;
  const auto x = static_cast<double>(body.x), z = static_cast<double>(body.z);
  return std::sqrt(x * x + z * z) / static_cast<double>(body.inverse_mass);
}

// Of `count` bodies, on vectors, from records of x, z, (s,) and inverse mass; returns how many are set: the
// rest fills no vector.
std::size_t set_impulse_sizes_of_four(const float* records, std::size_t count, double* sizes);
std::size_t set_impulse_sizes_of_four(const double* records, std::size_t count, double* sizes);
std::size_t set_impulse_sizes_of_three(const double* records, std::size_t count, double* sizes);

/// The sizes of bodies that are asked for one after the other.
template <class Body>
class ImpulseSizes {
  static constexpr std::size_t some = 128;

 public:
  explicit ImpulseSizes(std::span<const Body> bodies) : bodies_(bodies) {}

  double operator[](std::size_t b) {
    if (b < begin_ || b >= end_) set(b);
    return sizes_[b - begin_];
  }

 private:
  void set(std::size_t begin) {
    using T = decltype(Body::x);
    constexpr std::size_t numbers = sizeof(Body) / sizeof(T);
    static_assert(numbers == 3 || numbers == 4);
    begin_ = begin, end_ = std::min(bodies_.size(), begin + some);
    const T* const first = &bodies_[begin].x;
    std::size_t done = 0;
    if constexpr (numbers == 4)
      done = set_impulse_sizes_of_four(first, end_ - begin_, sizes_.data());
    else
      done = set_impulse_sizes_of_three(first, end_ - begin_, sizes_.data());
    for (std::size_t k = done; k < end_ - begin_; ++k) sizes_[k] = impulse_of(bodies_[begin_ + k]);
  }

  std::span<const Body> bodies_;
  std::size_t begin_ = 0, end_ = 0;
  std::array<double, some> sizes_;
};

}  // namespace drumlin::particles
