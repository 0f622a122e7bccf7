#include "particles/solver/reference_linear.hpp"

#include <array>
#include <cmath>

namespace drumlin::particles {

template <class Cone, bool with_spin>
ResponseSystem<BodyDelassus<Cone, with_spin>>::ResponseSystem(const Delassus& W) : W_(W) {
  for (const double inverse_mass : W.inverse_mass) place_.push_back(inverse_mass > 0 ? bodies_++ : -1);
  factors_.isSymmetric(true);  // in its pattern: the ordering then keeps the fill of a planar graph
}

/// 1 + M^-1/2 H^T D H M^-1/2: scaled by the masses, which may differ a million times. Entries of open
/// contacts are kept as zeros so that the pattern stays.
template <class Cone, bool with_spin>
void ResponseSystem<BodyDelassus<Cone, with_spin>>::assemble(std::span<const ContactResponse> D) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(static_cast<std::size_t>(W_.contacts()) * 4 * numbers * numbers);
  for (int k = 0; k < numbers * bodies_; ++k) entries.emplace_back(k, k, 1.0);
  using Row = Eigen::Matrix<double, 1, 2 * numbers>;
  for (int a = 0; a < W_.contacts(); ++a) {
    const std::array<int, 2> bodies{W_.i[a], W_.j[a]};
    Row n = Row::Zero(), t = Row::Zero();  // rows of H M^-1/2
    for (int side = 0; side < 2; ++side) {
      const double root = std::sqrt(W_.inverse_mass[bodies[side]]), sign = side == 0 ? root : -root;
      n[numbers * side] = sign * W_.n_x[a], n[numbers * side + 1] = sign * W_.n_z[a];
      t[numbers * side] = sign * W_.n_z[a], t[numbers * side + 1] = -sign * W_.n_x[a];
      if constexpr (with_spin) t[numbers * side + 2] = -std::sqrt(2.0) * root;  // J / r^2 = m / 2
    }
    Eigen::Matrix<double, 2 * numbers, 2 * numbers> block = D[a].nn * n.transpose() * n;
    if constexpr (dim == 2) block += t.transpose() * (D[a].tn * n + D[a].tt * t);
    for (int row = 0; row < 2 * numbers; ++row)
      for (int column = 0; column < 2 * numbers; ++column) {
        const int I = place_[bodies[row / numbers]], J = place_[bodies[column / numbers]];
        if (I >= 0 && J >= 0)
          entries.emplace_back(numbers * I + row % numbers, numbers * J + column % numbers,
                               block(row, column));
      }
  }
  matrix_.resize(numbers * bodies_, numbers * bodies_);
  matrix_.setFromTriplets(entries.begin(), entries.end());
}

template <class Cone, bool with_spin>
std::vector<double> ResponseSystem<BodyDelassus<Cone, with_spin>>::solution(
    std::span<const ContactResponse> D, std::span<const double> y) {
  assemble(D);
  if (!analysed_) factors_.analyzePattern(matrix_);
  analysed_ = true;
  factors_.factorize(matrix_);
  if (factors_.info() != Eigen::Success) return {};
  typename Delassus::State state;
  W_.load(state, y);
  Eigen::VectorXd momentum(numbers * bodies_);
  const auto scales = [](double inverse_mass) {
    const double root = std::sqrt(inverse_mass);
    return std::array<double, 3>{root, root, std::sqrt(2.0) * root};
  };
  for (std::size_t b = 0; b < state.size(); ++b) {
    if (place_[b] < 0) continue;
    const auto root = scales(W_.inverse_mass[b]);
    momentum[numbers * place_[b]] = state[b].x / root[0];
    momentum[numbers * place_[b] + 1] = state[b].z / root[1];
    if constexpr (with_spin) momentum[numbers * place_[b] + 2] = state[b].s / root[2];
  }
  const Eigen::VectorXd velocity = factors_.solve(momentum);
  for (std::size_t b = 0; b < state.size(); ++b) {
    if (place_[b] < 0) continue;
    const auto root = scales(W_.inverse_mass[b]);
    state[b].x = velocity[numbers * place_[b]] * root[0];
    state[b].z = velocity[numbers * place_[b] + 1] * root[1];
    if constexpr (with_spin) state[b].s = velocity[numbers * place_[b] + 2] * root[2];
  }
  std::vector<double> x(y.begin(), y.end());
  for (int a = 0; a < W_.contacts(); ++a) {
    const double u_n = W_.normal_velocity(state, a);
    x[dim * a] -= D[a].nn * u_n;
    if constexpr (dim == 2) x[2 * a + 1] -= D[a].tn * u_n + D[a].tt * W_.tangential_velocity(state, a);
  }
  return x;
}

std::vector<double> ResponseSystem<BlockDelassus>::solution(std::span<const ContactResponse> D,
                                                            std::span<const double> y) {
  // Unknowns in units of W_aa^-1/2 and rows of responding contacts divided by their size: the entries are
  // then near 1 whatever the masses and D.
  const int size = 2 * W_.contacts();
  const auto unit = [this](int k) { return std::sqrt(W_.diagonal[k / 2](k % 2, k % 2)); };
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd right(size);
  for (int a = 0; a < W_.contacts(); ++a) {
    const double row_scale = 1 / (1 + D[a].nn * W_.diagonal[a](0, 0));
    for (int c = 0; c < 2; ++c) {
      const int row = 2 * a + c;
      entries.emplace_back(row, row, row_scale);
      right[row] = row_scale * unit(row) * y[row];
    }
    if (D[a].nn == 0) continue;
    for (int k = W_.row_start[a]; k < W_.row_start[a + 1]; ++k)
      for (int c = 0; c < 2; ++c) {
        const int column = 2 * W_.column[k] + c;
        const double u_n = W_.block[k](0, c), u_t = W_.block[k](1, c), scale = row_scale / unit(column);
        entries.emplace_back(2 * a, column, scale * unit(2 * a) * D[a].nn * u_n);
        entries.emplace_back(2 * a + 1, column, scale * unit(2 * a + 1) * (D[a].tn * u_n + D[a].tt * u_t));
      }
  }
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Eigen::SparseMatrix<double>> factors;
  factors.compute(matrix);
  if (factors.info() != Eigen::Success) return {};
  const Eigen::VectorXd scaled = factors.solve(right);
  std::vector<double> x(size);
  for (int k = 0; k < size; ++k) x[k] = scaled[k] / unit(k);
  return x;
}

template class ResponseSystem<FrictionlessProblem::Delassus>;
template class ResponseSystem<CoulombProblem::Delassus>;
template class ResponseSystem<CoulombSpinProblem::Delassus>;

}  // namespace drumlin::particles
