#pragma once
// Diagonal entries of W, whatever its form.
#include "particles/contact/disc_delassus.hpp"
#include "particles/lab/block_delassus.hpp"

namespace drumlin::particles {

/// W_nn or W_tt of contact a.
template <int dim, bool spin>
double diagonal_entry(const DiscDelassus<dim, spin>& W, int a, int component) {
  const LocalMatrix own = W.block(a).matrix;
  return component == 0 ? own.nn : own.tt;
}
inline double diagonal_entry(const BlockDelassus& W, int a, int component) {
  return W.diagonal[a](component, component);
}

}  // namespace drumlin::particles
