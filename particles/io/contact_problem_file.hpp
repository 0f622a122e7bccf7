#pragma once
// Contact problems as files: FCLIB's HDF5 layout (/fclib_local), planar (docs/formats/contact-problem.md).
#include <filesystem>
#include <span>
#include <string>

#include "particles/contact/problems.hpp"

namespace drumlin::particles {

/// A problem as a file holds it.
struct ContactProblemFile {
  BlockProblem problem;  ///< with W made symmetric
  double asymmetry =
      0;  ///< largest |W_ij - W_ji| over the mean trace of the two diagonal blocks, before that
};

/// Reads /fclib_local/{spacedim, W/{nzmax,m,n,nz,p,i,x}, vectors/{q,mu}}: nz = -2 compressed rows, -1
/// compressed columns, >= 0 triplets; normal component first; u = W r + q. Throws InputError for whatever
/// does not fit: another dimension, indices outside the matrix, a contact without a positive diagonal, a W
/// that is asymmetric by more than 1e-5, numbers that are not finite.
ContactProblemFile read_contact_problem_file(const std::filesystem::path& file);
/// The problem alone.
BlockProblem read_contact_problem(const std::filesystem::path& file);

/// Writes /solution/{r, u}, each 2 * contacts numbers. Throws IoError.
void write_contact_solution(const std::filesystem::path& file, std::span<const double> r,
                            std::span<const double> u);

/// Writes a problem in the same layout, W in compressed rows; `description` goes to /fclib_local/info.
void write_contact_problem(const std::filesystem::path& file, const BlockProblem& problem,
                           const std::string& description);

}  // namespace drumlin::particles
