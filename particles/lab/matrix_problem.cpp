#include "particles/lab/matrix_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace drumlin::particles {
namespace {

constexpr double largest_asymmetry =
    1e-5;  // of the diagonal; beyond, it is no matrix written with few digits

bool is_positive_definite(const Eigen::Matrix2d& block) {
  return block(0, 0) > 0 && block(1, 1) > 0 && block.determinant() > 0;
}

/// Rows of blocks by contacts, columns ascending in each.
struct BlockRows {
  std::vector<int> start{0}, column;
  std::vector<Eigen::Matrix2d> block;

  std::size_t count() const { return start.size() - 1; }
  /// Place of a block; -1 if there is none.
  int find(int row, int at) const {
    const auto begin = column.begin() + start[row], end = column.begin() + start[row + 1];
    const auto found = std::lower_bound(begin, end, at);
    return found != end && *found == at ? static_cast<int>(found - column.begin()) : -1;
  }
};

/// Adds up the entries of each block in the order in which they come: triplets may repeat.
class BlockSums {
 public:
  BlockSums(std::span<const MatrixEntry> entries, std::size_t contacts)
      : entries_(entries), first_(contacts + 1), place_(contacts, -1) {
    for (const MatrixEntry& entry : entries) ++first_[entry.row / 2 + 1];
    for (std::size_t a = 0; a < contacts; ++a) first_[a + 1] += first_[a];
    order_.resize(entries.size());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t k = 0; k < entries.size(); ++k) order_[next[entries[k].row / 2]++] = k;
  }

  BlockRows rows() {
    BlockRows rows;
    rows.column.reserve(entries_.size() / 4), rows.block.reserve(entries_.size() / 4);
    for (std::size_t a = 0; a + 1 < first_.size(); ++a) {
      add_row(a);
      std::sort(columns_.begin(), columns_.end());
      for (const int column : columns_) {
        rows.column.push_back(column), rows.block.push_back(blocks_[place_[column]]);
        place_[column] = -1;
      }
      rows.start.push_back(static_cast<int>(rows.column.size()));
    }
    return rows;
  }

 private:
  void add_row(std::size_t a) {
    columns_.clear(), blocks_.clear();
    for (std::size_t k = first_[a]; k < first_[a + 1]; ++k) {
      const MatrixEntry& entry = entries_[order_[k]];
      int& place = place_[entry.column / 2];
      if (place < 0) {
        place = static_cast<int>(blocks_.size());
        columns_.push_back(entry.column / 2), blocks_.emplace_back(Eigen::Matrix2d::Zero());
      }
      blocks_[place](entry.row % 2, entry.column % 2) += entry.value;
    }
  }

  std::span<const MatrixEntry> entries_;
  std::vector<std::size_t> first_, order_;  // of the entries, row of blocks by row of blocks
  std::vector<int> place_;                  // of each column among the blocks of the row at work, or -1
  std::vector<int> columns_;
  std::vector<Eigen::Matrix2d> blocks_;
};

/// Zeros in the place of blocks whose transposed block alone is there.
std::vector<MatrixEntry> missing_blocks(const BlockRows& rows) {
  std::vector<MatrixEntry> missing;
  for (int a = 0; a < static_cast<int>(rows.count()); ++a)
    for (int k = rows.start[a]; k < rows.start[a + 1]; ++k)
      if (rows.find(rows.column[k], a) < 0) missing.push_back({2 * rows.column[k], 2 * a, 0});
  return missing;
}

/// Makes W symmetric, block by block; returns how far it was from it: the largest difference of two entries
/// that should be one, of the mean size of the two diagonal blocks. Every block has its transposed one.
double symmetrise(BlockRows& rows) {
  const auto size = [&](int a) { return std::abs(rows.block[rows.find(a, a)].trace()); };
  double largest = 0;
  for (int a = 0; a < static_cast<int>(rows.count()); ++a)
    for (int k = rows.start[a]; k < rows.start[a + 1]; ++k) {
      const int b = rows.column[k];
      if (b < a) continue;  // done from there
      Eigen::Matrix2d &block = rows.block[k], &other = rows.block[rows.find(b, a)];
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
  BlockRows rows = BlockSums(entries, contacts).rows();
  const auto refuse = [&](int a) {
    refuse_as("W", "contact " + std::to_string(a) + " has no symmetric positive definite diagonal block");
  };
  const int count = static_cast<int>(contacts);
  for (int a = 0; a < count; ++a)
    if (rows.find(a, a) < 0) refuse(a);
  if (const auto missing = missing_blocks(rows); !missing.empty()) {
    std::vector<MatrixEntry> all(entries.begin(), entries.end());
    all.insert(all.end(), missing.begin(), missing.end());
    rows = BlockSums(all, contacts).rows();
  }
  asymmetry = symmetrise(rows);
  if (!(asymmetry <= largest_asymmetry))
    refuse_as("W", fmt::format("is not symmetric: entries that should be equal differ by {:.1g} of the "
                               "diagonal (allowed: {:g})",
                               asymmetry, largest_asymmetry));
  for (int a = 0; a < count; ++a)
    if (!is_positive_definite(rows.block[rows.find(a, a)])) refuse(a);
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
  for (const double value : mu)
    if (!(value >= 0 && value <= largest_friction))
      refuse("mu", fmt::format("friction {:g} (allowed: 0 to {:g})", value, largest_friction));
  check_entries(W, q.size(), refuse);
  MatrixProblem result;
  BlockRows rows = rows_of_W(W, contacts, refuse, result.asymmetry);
  auto& blocks = result.problem.W;
  for (int a = 0; a < static_cast<int>(contacts); ++a) blocks.diagonal.push_back(rows.block[rows.find(a, a)]);
  blocks.row_start = std::move(rows.start);
  blocks.column = std::move(rows.column);
  blocks.block = std::move(rows.block);
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
