#include "particles/io/contact_problem_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include "coupling/files/h5_image.hpp"

namespace drumlin::particles {
namespace {

struct Entry {
  std::int32_t row = 0, column = 0;
  double value = 0;
};

const std::string root = "fclib_local/", time_step_name = "drumlin/time_step";
constexpr double largest_asymmetry = 1e-5;  // of the diagonal; beyond, it is no file written with few digits

void check_entry(const H5Reader& in, const Entry& entry, std::int64_t size) {
  if (entry.row < 0 || entry.row >= size || entry.column < 0 || entry.column >= size)
    in.refuse(root + "W", "an index lies outside the matrix");
  if (!std::isfinite(entry.value)) in.refuse(root + "W/x", "a number is not finite");
}

/// Entries of a compressed matrix: pointers p over the major index, minor indices i.
std::vector<Entry> compressed(const H5Reader& in, bool rows_are_major, std::int64_t size) {
  const auto p = in.ints(root + "W/p"), i = in.ints(root + "W/i");
  const auto x = in.doubles(root + "W/x");
  if (static_cast<std::int64_t>(p.size()) < size + 1) in.refuse(root + "W/p", "fewer entries than rows + 1");
  std::vector<Entry> entries;
  for (std::int64_t major = 0; major < size; ++major) {
    if (p[major] < 0 || p[major + 1] < p[major] ||
        static_cast<std::size_t>(p[major + 1]) > std::min(i.size(), x.size()))
      in.refuse(root + "W/p", "pointers outside the entries");
    for (std::int32_t k = p[major]; k < p[major + 1]; ++k) {
      const auto m = static_cast<std::int32_t>(major);
      entries.push_back(rows_are_major ? Entry{m, i[k], x[k]} : Entry{i[k], m, x[k]});
    }
  }
  return entries;
}

std::vector<Entry> triplets(const H5Reader& in, std::int64_t count) {
  const auto columns = in.ints(root + "W/p"), rows = in.ints(root + "W/i");
  const auto x = in.doubles(root + "W/x");
  if (count > static_cast<std::int64_t>(std::min({columns.size(), rows.size(), x.size()})))
    in.refuse(root + "W/nz", "more triplets than stored");
  std::vector<Entry> entries;
  for (std::int64_t k = 0; k < count; ++k) entries.push_back({rows[k], columns[k], x[k]});
  return entries;
}

std::vector<Entry> entries_of_W(const H5Reader& in, std::int64_t size) {
  const std::int64_t nz = in.integer(root + "W/nz");
  std::vector<Entry> entries;
  if (nz == -2)
    entries = compressed(in, true, size);
  else if (nz == -1)
    entries = compressed(in, false, size);
  else if (nz >= 0)
    entries = triplets(in, nz);
  else
    in.refuse(root + "W/nz", std::to_string(nz) + " (allowed: -2 rows, -1 columns, >= 0 triplets)");
  for (const Entry& entry : entries) check_entry(in, entry, size);
  return entries;
}

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
BlockRows rows_of_W(const H5Reader& in, std::int64_t size, double& asymmetry) {
  BlockRows rows(static_cast<std::size_t>(size / 2));
  for (const Entry& entry : entries_of_W(in, size)) {
    auto [place, fresh] = rows[entry.row / 2].try_emplace(entry.column / 2, Eigen::Matrix2d::Zero());
    place->second(entry.row % 2, entry.column % 2) += entry.value;  // triplets may repeat
  }
  const auto refuse = [&](std::size_t a) {
    in.refuse(root + "W",
              "contact " + std::to_string(a) + " has no symmetric positive definite diagonal block");
  };
  for (std::size_t a = 0; a < rows.size(); ++a)
    if (!rows[a].contains(static_cast<int>(a))) refuse(a);
  asymmetry = symmetrise(rows);
  if (!(asymmetry <= largest_asymmetry))
    in.refuse(root + "W",
              fmt::format("is not symmetric: entries that should be equal differ by {:.1g} of the "
                          "diagonal (allowed: {:g})",
                          asymmetry, largest_asymmetry));
  for (std::size_t a = 0; a < rows.size(); ++a)
    if (!is_positive_definite(rows[a].at(static_cast<int>(a)))) refuse(a);
  return rows;
}

std::vector<double> vector_of(const H5Reader& in, const std::string& name, std::int64_t size) {
  std::size_t count = 1;
  for (const std::size_t length : in.shape(root + "vectors/" + name)) count *= length;
  if (static_cast<std::int64_t>(count) != size)
    in.refuse(root + "vectors/" + name, "not of length " + std::to_string(size));
  auto values = in.doubles(root + "vectors/" + name);
  for (const double value : values)
    if (!std::isfinite(value)) in.refuse(root + "vectors/" + name, "a number is not finite");
  return values;
}

std::optional<double> time_step_of(const H5Reader& in) {
  if (!in.has(time_step_name)) return std::nullopt;
  const double step = in.number(time_step_name);
  if (!(step > 0 && std::isfinite(step))) in.refuse(time_step_name, "must be positive");
  return step;
}

}  // namespace

ContactProblemFile read_contact_problem_file(const std::filesystem::path& file) {
  const H5Reader in(file, false);
  if (in.integer(root + "spacedim") != 2) in.refuse(root + "spacedim", "only 2 is solved here");
  for (const char* equality : {"V", "R"})
    if (in.has(root + equality)) in.refuse(root + equality, "equality constraints are not solved here");
  const std::int64_t size = in.integer(root + "W/m");
  if (size != in.integer(root + "W/n") || size % 2 != 0 || size <= 0 || size > (std::int64_t{1} << 28))
    in.refuse(root + "W/m", "not a square matrix of 2 rows per contact");
  ContactProblemFile read;
  BlockProblem& problem = read.problem;
  problem.q = vector_of(in, "q", size);
  problem.mu = vector_of(in, "mu", size / 2);
  for (const double mu : problem.mu)
    if (mu < 0) in.refuse(root + "vectors/mu", "negative friction");
  read.time_step = time_step_of(in);
  auto& W = problem.W;
  W.row_start.push_back(0);
  int a = 0;
  for (const auto& row : rows_of_W(in, size, read.asymmetry)) {
    W.diagonal.push_back(row.at(a++));
    for (const auto& [column, block] : row) W.column.push_back(column), W.block.push_back(block);
    W.row_start.push_back(static_cast<int>(W.column.size()));
  }
  return read;
}

BlockProblem read_contact_problem(const std::filesystem::path& file) {
  return read_contact_problem_file(file).problem;
}

void write_contact_solution(const std::filesystem::path& file, std::span<const double> r,
                            std::span<const double> u, const ContactNotes& notes) {
  H5Writer out;
  out.add("solution/r", r);
  out.add("solution/u", u);
  if (!notes.state.empty()) out.add("solution/state", std::span(notes.state));
  if (!notes.changes.empty()) out.add("solution/changes", std::span(notes.changes));
  if (!notes.error.empty()) out.add("solution/error", std::span(notes.error));
  out.save(file);
}

void write_contact_problem(const std::filesystem::path& file, const BlockProblem& problem,
                           const ContactPlaces& places, const std::string& description) {
  const auto size = static_cast<std::int32_t>(problem.q.size());
  std::vector<std::int32_t> p{0}, i;
  std::vector<double> x;
  for (int row = 0; row < size; ++row) {
    for (int k = problem.W.row_start[row / 2]; k < problem.W.row_start[row / 2 + 1]; ++k)
      for (int c = 0; c < 2; ++c) {
        i.push_back(2 * problem.W.column[k] + c);
        x.push_back(problem.W.block[k](row % 2, c));
      }
    p.push_back(static_cast<std::int32_t>(i.size()));
  }
  H5Writer out;
  const auto add_int = [&out](const std::string& name, std::int32_t value) {
    out.add(root + name, std::span<const std::int32_t>(&value, 1));
  };
  add_int("spacedim", 2);
  add_int("W/nzmax", static_cast<std::int32_t>(x.size()));
  add_int("W/m", size), add_int("W/n", size), add_int("W/nz", -2);
  out.add(root + "W/p", std::span<const std::int32_t>(p));
  out.add(root + "W/i", std::span<const std::int32_t>(i));
  out.add(root + "W/x", std::span<const double>(x));
  out.add(root + "vectors/q", std::span<const double>(problem.q));
  out.add(root + "vectors/mu", std::span<const double>(problem.mu));
  out.add(root + "vectors/s", std::span<const double>());
  out.add_text(root + "info/description", description);
  out.add_number(time_step_name, problem.time_step);
  const std::string group = "drumlin/contacts/";
  if (!places.x.empty()) {
    out.add(group + "x", std::span(places.x)), out.add(group + "z", std::span(places.z));
    out.add(group + "normal_x", std::span(places.normal_x));
    out.add(group + "normal_z", std::span(places.normal_z));
  }
  out.save(file);
}

}  // namespace drumlin::particles
