#include "particles/lab/contact_problem_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/hdf5/h5_reader.hpp"
#include "coupling/core/hdf5/h5_writer.hpp"
#include "particles/lab/matrix_problem.hpp"

namespace drumlin::particles {
namespace {

const std::string root = "fclib_local/", time_step_name = "drumlin/time_step";

/// Entries of a compressed matrix: pointers p over the major index, minor indices i.
std::vector<MatrixEntry> compressed(const H5Reader& in, bool rows_are_major, std::int64_t size) {
  const auto p = in.ints(root + "W/p"), i = in.ints(root + "W/i");
  const auto x = in.doubles(root + "W/x");
  if (static_cast<std::int64_t>(p.size()) != size + 1 || p.front() != 0)
    in.refuse(root + "W/p", "not of rows + 1 entries, from 0 on");
  std::vector<MatrixEntry> entries;
  entries.reserve(std::min(i.size(), x.size()));
  for (std::int64_t major = 0; major < size; ++major) {
    if (p[major] < 0 || p[major + 1] < p[major] ||
        static_cast<std::size_t>(p[major + 1]) > std::min(i.size(), x.size()))
      in.refuse(root + "W/p", "pointers outside the entries");
    for (std::int32_t k = p[major]; k < p[major + 1]; ++k) {
      const auto m = static_cast<std::int32_t>(major);
      entries.push_back(rows_are_major ? MatrixEntry{m, i[k], x[k]} : MatrixEntry{i[k], m, x[k]});
    }
  }
  return entries;
}

std::vector<MatrixEntry> triplets(const H5Reader& in, std::int64_t count) {
  const auto columns = in.ints(root + "W/p"), rows = in.ints(root + "W/i");
  const auto x = in.doubles(root + "W/x");
  if (count > static_cast<std::int64_t>(std::min({columns.size(), rows.size(), x.size()})))
    in.refuse(root + "W/nz", "more triplets than stored");
  std::vector<MatrixEntry> entries;
  entries.reserve(static_cast<std::size_t>(count));
  for (std::int64_t k = 0; k < count; ++k) entries.push_back({rows[k], columns[k], x[k]});
  return entries;
}

std::vector<MatrixEntry> entries_of_W(const H5Reader& in, std::int64_t size) {
  const std::int64_t nz = in.integer(root + "W/nz");
  if (nz == -2) return compressed(in, true, size);
  if (nz == -1) return compressed(in, false, size);
  if (nz >= 0) return triplets(in, nz);
  in.refuse(root + "W/nz", std::to_string(nz) + " (allowed: -2 rows, -1 columns, >= 0 triplets)");
}

std::vector<double> vector_of(const H5Reader& in, const std::string& name, std::int64_t size) {
  const std::vector<std::size_t> shape = in.shape(root + "vectors/" + name);
  if (shape.size() != 1 || static_cast<std::int64_t>(shape[0]) != size)
    in.refuse(root + "vectors/" + name, "not of length " + std::to_string(size));
  return in.doubles(root + "vectors/" + name);
}

std::optional<double> time_step_of(const H5Reader& in) {
  if (!in.has(time_step_name)) return std::nullopt;
  return in.number(time_step_name, H5Range::above_0);
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
  const std::vector<double> q = vector_of(in, "q", size), mu = vector_of(in, "mu", size / 2);
  const auto time_step = time_step_of(in);
  const auto refuse = [&](const std::string& name, const std::string& what) {
    in.refuse(root + (name.starts_with("W") ? name : "vectors/" + name), what);
  };
  MatrixProblem read = matrix_problem(entries_of_W(in, size), q, mu, refuse);
  return {std::move(read.problem), read.asymmetry, time_step};
}

BlockProblem read_contact_problem(const std::filesystem::path& file) {
  return read_contact_problem_file(file).problem;
}

void write_contact_solution(const std::filesystem::path& file, std::span<const double> r,
                            std::span<const double> u, const ContactNotes& notes) {
  H5Writer out;
  out.add("solution/r", r, {"of q over that of W", "impulses, normal and tangential of each contact"});
  out.add("solution/u", u, {"of q", "relative velocities, normal and tangential of each contact"});
  if (!notes.state.empty()) out.add("solution/state", notes.state, {"1", "0: open, 1: sticking, 2: sliding"});
  if (!notes.changes.empty()) out.add("solution/changes", notes.changes, {"1", "changes of that state"});
  if (!notes.error.empty()) out.add("solution/error", notes.error, {"1", "e_a over the rms of q"});
  out.save(file);
}

void write_contact_problem(const std::filesystem::path& file, const BlockProblem& problem,
                           const ContactPlaces& places, const std::string& description) {
  constexpr std::int64_t most = std::numeric_limits<std::int32_t>::max();
  if (4 * static_cast<std::int64_t>(problem.W.block.size()) > most)
    throw IoError(file.string() + ": cannot be written: its layout counts the entries of W in 32 bits");
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
  out.add(root + "W/p", p), out.add(root + "W/i", i);
  out.add(root + "W/x", x, {"1/(rho0 d^2)", "velocity per impulse"});
  out.add(root + "vectors/q", problem.q,
          {"sqrt(g d)", "relative velocities without impulses, normal and tangential of each contact"});
  out.add(root + "vectors/mu", problem.mu, {"1", "friction of each contact"});
  out.add(root + "vectors/s", std::span<const double>());
  out.add_text(root + "info/description", description);
  out.add_number(time_step_name, problem.time_step, {"sqrt(d/g)", "time step"});
  const std::string group = "drumlin/contacts/";
  if (!places.x.empty()) {
    out.add(group + "x", places.x, {"d", "position after the step"});
    out.add(group + "z", places.z, {"d", "position after the step"});
    out.add(group + "normal_x", places.normal_x, {"1", "unit normal towards the grain"});
    out.add(group + "normal_z", places.normal_z, {"1", "unit normal towards the grain"});
  }
  out.save(file);
}

}  // namespace drumlin::particles
