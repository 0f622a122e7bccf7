#include "particles/contact/matrix_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

namespace drumlin::particles {
namespace {

constexpr double largest_asymmetry =
    1e-5;  // of the diagonal; beyond, it is no matrix written with few digits

bool is_positive_definite(const Eigen::Matrix2d& block) {
  return block(0, 0) > 0 && block(1, 1) > 0 && block.determinant() > 0;
}

using BlockRows = std::vector<std::map<int, Eigen::Matrix2d>>;

/// Makes W symmetric, block by block; returns how far it was from it: the largest difference of two entries
/// that should be one, of the mean size of the two diagonal blocks. Every row has a diagonal block.
double symmetrise(BlockRows& rows) {
  const auto size = [&](int a) { return std::abs(rows[static_cast<std::size_t>(a)].at(a).trace()); };
  double largest = 0;
  for (int a = 0; a < static_cast<int>(rows.size()); ++a)
    for (auto& [b, block] : rows[static_cast<std::size_t>(a)]) {
      Eigen::Matrix2d& other =
          rows[static_cast<std::size_t>(b)].try_emplace(a, Eigen::Matrix2d::Zero()).first->second;
      const Eigen::Matrix2d mean = 0.5 * (block + other.transpose());
      const double difference = (block - other.transpose()).cwiseAbs().maxCoeff();
      const double share = difference == 0 ? 0 : 2 * difference / (size(a) + size(b));
      // NaN comes of sums that are too large, and must not pass as none.
      if (!std::isfinite(share)) return std::numeric_limits<double>::infinity();
      largest = std::max(largest, share);
      block = mean;
      other = mean.transpose();
    }
  return largest;
}

/// The blocks of W by contacts, symmetric; `asymmetry` is what they were away from it.
BlockRows rows_of_W(std::span<const MatrixEntry> entries, std::size_t contacts, const Refusal& refuse_as,
                    double& asymmetry) {
  BlockRows rows(contacts);
  for (const MatrixEntry& entry : entries) {
    auto [place, fresh] = rows[entry.row / 2].try_emplace(entry.column / 2, Eigen::Matrix2d::Zero());
    place->second(entry.row % 2, entry.column % 2) += entry.value;  // triplets may repeat
  }
  const auto refuse = [&](std::size_t a) {
    refuse_as("W", "contact " + std::to_string(a) + " has no symmetric positive definite diagonal block");
  };
  for (std::size_t a = 0; a < rows.size(); ++a)
    if (!rows[a].contains(static_cast<int>(a))) refuse(a);
  asymmetry = symmetrise(rows);
  if (!(asymmetry <= largest_asymmetry))
    refuse_as("W", fmt::format("is not symmetric: entries that should be equal differ by {:.1g} of the "
                               "diagonal (allowed: {:g})",
                               asymmetry, largest_asymmetry));
  for (std::size_t a = 0; a < rows.size(); ++a)
    if (!is_positive_definite(rows[a].at(static_cast<int>(a)))) refuse(a);
  return rows;
}

void check_entries(std::span<const MatrixEntry> entries, std::size_t size, const Refusal& refuse) {
  const auto inside = [&](std::int32_t index) {
    return index >= 0 && static_cast<std::size_t>(index) < size;
  };
  for (const MatrixEntry& entry : entries) {
    if (!inside(entry.row) || !inside(entry.column)) refuse("W", "an index lies outside the matrix");
    if (!std::isfinite(entry.value)) refuse("W/x", "a number is not finite");
  }
}

void check_finite(std::span<const double> values, const char* name, const Refusal& refuse) {
  for (const double value : values)
    if (!std::isfinite(value)) refuse(name, "a number is not finite");
}

}  // namespace

MatrixProblem matrix_problem(std::span<const MatrixEntry> W, std::vector<double> q, std::vector<double> mu,
                             const Refusal& refuse) {
  const std::size_t contacts = mu.size();
  if (contacts == 0) refuse("mu", "is empty");
  if (q.size() != 2 * contacts) refuse("q", fmt::format("not of length {}", 2 * contacts));
  check_finite(q, "q", refuse);
  check_finite(mu, "mu", refuse);
  if (std::any_of(mu.begin(), mu.end(), [](double value) { return value < 0; }))
    refuse("mu", "negative friction");
  check_entries(W, q.size(), refuse);
  MatrixProblem result;
  auto& rows = result.problem.W;
  rows.row_start.push_back(0);
  int a = 0;
  for (const auto& row : rows_of_W(W, contacts, refuse, result.asymmetry)) {
    rows.diagonal.push_back(row.at(a++));
    for (const auto& [column, block] : row) rows.column.push_back(column), rows.block.push_back(block);
    rows.row_start.push_back(static_cast<int>(rows.column.size()));
  }
  result.problem.q = std::move(q);
  result.problem.mu = std::move(mu);
  return result;
}

BlockProblem dense_problem(std::span<const double> W, std::vector<double> q, std::vector<double> mu) {
  const auto refuse = [](const std::string& name, const std::string& what) {
    throw std::invalid_argument(name + ": " + what);
  };
  const std::size_t size = q.size();
  if (W.size() != size * size) refuse("W", fmt::format("not of {} rows and columns", size));
  std::vector<MatrixEntry> entries;
  for (std::size_t k = 0; k < W.size(); ++k)
    if (W[k] != 0)
      entries.push_back({static_cast<std::int32_t>(k / size), static_cast<std::int32_t>(k % size), W[k]});
  return matrix_problem(entries, std::move(q), std::move(mu), refuse).problem;
}

}  // namespace drumlin::particles
