#pragma once
// Diagonal entries of W, whatever its form.
#include "particles/contact/block_delassus.hpp"
#include "particles/contact/body_delassus.hpp"

namespace drumlin::particles {

/// W_nn or W_tt of contact a.
template <class Cone, bool with_spin>
double diagonal_entry(const BodyDelassus<Cone, with_spin>& W, int a, int component) {
  return component == 0 ? 1 / W.inverse_W_nn[a] : W.largest_eigenvalue(a);  // discs: W_tt >= W_nn
}
inline double diagonal_entry(const BlockDelassus& W, int a, int component) {
  return W.diagonal[a](component, component);
}

}  // namespace drumlin::particles
