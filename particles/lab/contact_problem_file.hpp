#pragma once
// Contact problems as files: FCLIB's HDF5 layout (/fclib_local), planar (docs/formats/contact-problem.md).
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "particles/contact/contact_places.hpp"
#include "particles/lab/block_delassus.hpp"

namespace drumlin::particles {

/// A problem as a file holds it.
struct ContactProblemFile {
  BlockProblem problem;  ///< with W made symmetric
  double asymmetry =
      0;  ///< largest |W_ij - W_ji| over the mean trace of the two diagonal blocks, before that
  std::optional<double> time_step;  ///< in sqrt(d/g); what `drumlin run` writes says it
};

/// Reads /fclib_local/{spacedim, W/{nzmax,m,n,nz,p,i,x}, vectors/{q,mu}}: nz = -2 compressed rows, -1
/// compressed columns, >= 0 triplets; normal component first; u = W r + q. The time step is
/// /drumlin/time_step, if there. Throws InputError for whatever does not fit:
/// another dimension, indices outside the matrix, a contact without a positive diagonal, a W that is
/// asymmetric by more than 1e-5, numbers that are not finite.
ContactProblemFile read_contact_problem_file(const std::filesystem::path& file);
/// The problem alone.
BlockProblem read_contact_problem(const std::filesystem::path& file);

/// What is said of each contact beside a solution; what is empty is left out of the file.
struct ContactNotes {
  std::vector<std::int32_t> state;    ///< 0 open, 1 sticking, 2 sliding
  std::vector<std::int32_t> changes;  ///< of its state in further sweeps
  std::vector<double> error;          ///< e_a / rms of all entries of q (docs/conventions.md)
};

/// Writes /solution/{r, u}, each 2 * contacts numbers, and the notes. Throws IoError.
void write_contact_solution(const std::filesystem::path& file, std::span<const double> r,
                            std::span<const double> u, const ContactNotes& notes = {});

/// Writes a problem in the same layout, W in compressed rows; `description` goes to /fclib_local/info. What
/// FCLIB has no place for, the time step and where the contacts are, goes to /drumlin.
void write_contact_problem(const std::filesystem::path& file, const BlockProblem& problem,
                           const ContactPlaces& places, const std::string& description);

}  // namespace drumlin::particles
