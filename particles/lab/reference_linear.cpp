#include "particles/lab/reference_linear.hpp"

#include <cmath>

namespace drumlin::particles {

template <int dim, bool with_spin>
std::vector<double> ResponseSystem<DiscDelassus<dim, with_spin>>::solution(std::span<const ContactResponse> D,
                                                                           std::span<const double> y) {
  if (!bodies_.factorise(D)) return {};
  const std::vector<double> u = bodies_.velocities(bodies_.solution(bodies_.momentum(y)));
  std::vector<double> x(y.begin(), y.end());
  for (int a = 0; a < bodies_.contacts(); ++a) {
    x[dim * a] -= D[a].nn * u[dim * a];
    if constexpr (dim == 2) x[2 * a + 1] -= D[a].tn * u[2 * a] + D[a].tt * u[2 * a + 1];
  }
  return x;
}

namespace {

/// Two successive rows of the matrix per contact: columns of its transposed.
SparsePattern rows_of_blocks(const BlockDelassus& W) {
  SparsePattern pattern;
  pattern.column_start.push_back(0);
  for (int row = 0; row < 2 * W.contacts(); ++row) {
    for (int k = W.row_start[row / 2]; k < W.row_start[row / 2 + 1]; ++k)
      pattern.row.insert(pattern.row.end(), {2 * W.column[k], 2 * W.column[k] + 1});
    pattern.column_start.push_back(static_cast<int>(pattern.row.size()));
  }
  return pattern;
}

}  // namespace

ResponseSystem<BlockDelassus>::ResponseSystem(const BlockDelassus& W)
    : W_(W), transposed_(rows_of_blocks(W)) {}

/// Unknowns are in units of W_aa^-1/2, and rows of responding contacts are divided by their size: the entries
/// are then near 1 whatever the masses and D.
std::vector<double> ResponseSystem<BlockDelassus>::solution(std::span<const ContactResponse> D,
                                                            std::span<const double> y) {
  const int size = 2 * W_.contacts();
  const auto unit = [this](int k) { return std::sqrt(W_.diagonal[k / 2](k % 2, k % 2)); };
  std::vector<double> values, right(size), x(size);
  for (int row = 0; row < size; ++row) {
    const int a = row / 2;
    const double row_scale = 1 / (1 + D[a].nn * W_.diagonal[a](0, 0)), scale = row_scale * unit(row);
    const double by_n = row % 2 == 0 ? D[a].nn : D[a].tn, by_t = row % 2 == 0 ? 0 : D[a].tt;
    right[row] = scale * y[row];
    for (int k = W_.row_start[a]; k < W_.row_start[a + 1]; ++k)
      for (int c = 0; c < 2; ++c) {
        const int column = 2 * W_.column[k] + c;
        const double coupling = by_n * W_.block[k](0, c) + by_t * W_.block[k](1, c);
        values.push_back(scale / unit(column) * coupling + (row == column ? row_scale : 0));
      }
  }
  if (!transposed_.factorise(std::move(values))) return {};
  transposed_.solve_transposed(right, x);
  for (int k = 0; k < size; ++k) x[k] /= unit(k);
  return x;
}

template class ResponseSystem<FrictionlessProblem::Delassus>;
template class ResponseSystem<CoulombProblem::Delassus>;
template class ResponseSystem<CoulombSpinProblem::Delassus>;

}  // namespace drumlin::particles
