// Compiled once for each instruction set: foreach_target.h includes this file again and again.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "particles/contact/squared_errors.cpp"
#include <hwy/foreach_target.h>
// Must come after foreach_target.h.
#include <hwy/highway.h>

#include "particles/contact/squared_errors.hpp"
#include "particles/contact_law/laws-inl.h"

HWY_BEFORE_NAMESPACE();
namespace drumlin::particles::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The contacts that fill vectors; returns how many these are.
template <class Law>
std::size_t errors_on_vectors(double largest, const double* inverse_W_nn, const double* mu, const double* r,
                              const double* u, std::span<double> errors) {
  const hn::CappedTag<double, 8> d;
  using V = hn::Vec<decltype(d)>;
  const V one = hn::Set(d, 1.0);
  std::size_t k = 0;
  for (; k + hn::Lanes(d) <= errors.size(); k += hn::Lanes(d)) {
    const V lambda = hn::Div(hn::Set(d, largest), hn::LoadU(d, inverse_W_nn + k));
    const V rho = hn::Div(one, lambda);
    V squares;
    if constexpr (Law::unknowns == 1) {
      const std::array<V, 1> r_k{hn::LoadU(d, r + k)}, u_k{hn::LoadU(d, u + k)};
      squares = contact_law::squared_natural_residual(Law{}, rho, {}, r_k, u_k);
    } else {
      std::array<V, 2> r_k, u_k;
      hn::LoadInterleaved2(d, r + 2 * k, r_k[0], r_k[1]);
      hn::LoadInterleaved2(d, u + 2 * k, u_k[0], u_k[1]);
      squares = contact_law::squared_natural_residual(Law{}, rho, {hn::LoadU(d, mu + k)}, r_k, u_k);
    }
    hn::StoreU(hn::Mul(squares, hn::Mul(lambda, lambda)), d, errors.data() + k);
  }
  return k;
}

std::size_t errors_without_friction(double largest, const double* inverse_W_nn, const double* mu,
                                    const double* r, const double* u, std::span<double> errors) {
  return errors_on_vectors<Frictionless>(largest, inverse_W_nn, mu, r, u, errors);
}
std::size_t errors_with_friction(double largest, const double* inverse_W_nn, const double* mu,
                                 const double* r, const double* u, std::span<double> errors) {
  return errors_on_vectors<Coulomb>(largest, inverse_W_nn, mu, r, u, errors);
}

}  // namespace drumlin::particles::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace drumlin::particles {

HWY_EXPORT(errors_without_friction);
HWY_EXPORT(errors_with_friction);

template <class Law>
void set_squared_errors(double largest_in_W_nn, const double* inverse_W_nn, const double* mu, const double* r,
                        const double* u, std::span<double> errors) {
  std::size_t done = 0;
  if constexpr (Law::unknowns == 1)
    done = HWY_DYNAMIC_DISPATCH(errors_without_friction)(largest_in_W_nn, inverse_W_nn, mu, r, u, errors);
  else
    done = HWY_DYNAMIC_DISPATCH(errors_with_friction)(largest_in_W_nn, inverse_W_nn, mu, r, u, errors);
  for (std::size_t k = done; k < errors.size(); ++k)
    errors[k] = squared_error<Law>(largest_in_W_nn / inverse_W_nn[k], mu + Law::coefficients * k,
                                   r + Law::unknowns * k, u + Law::unknowns * k);
}
template void set_squared_errors<Frictionless>(double, const double*, const double*, const double*,
                                               const double*, std::span<double>);
template void set_squared_errors<Coulomb>(double, const double*, const double*, const double*, const double*,
                                          std::span<double>);

}  // namespace drumlin::particles
#endif  // HWY_ONCE
