#pragma once
// The numbers of one instant as another program wrote them, with the place of each row.
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coupling/core/basics/scales.hpp"

namespace drumlin::particles {

/// What a column holds: decides its unit. Forces are per metre of depth.
enum class Quantity { number, time, length, velocity, rate, force };

/// What one unit of a quantity inside the libraries is in SI.
double unit_of(Quantity quantity, const Scales& scales);

struct FrameColumn {
  std::vector<double> values;
  Quantity quantity = Quantity::number;
  bool in_si = true;  ///< false: dimensionless already
};

/// Columns by the names of docs/formats/import.md without their units: id, x, z, v_x, v_z, radius,
/// spin_clockwise, spin_anticlockwise, type, third of grains; i, j, normal_x, normal_z, f_n, f_t, f_x, f_z of
/// contacts.
struct FrameTable {
  std::string file;
  std::vector<int> line;  ///< of each row
  int first_line = 0;     ///< where the instant begins
  std::optional<double> time;
  bool time_in_si = true;
  std::optional<double> period_m;  ///< along x, where the file says that it is periodic
  std::map<std::string, FrameColumn> columns;
  std::string all_names;  ///< as they stand in the file
  /// What the file calls them, also those that it lacks: errors use its own words.
  std::map<std::string, std::string> words;

  std::string word(const std::string& name) const { return words.contains(name) ? words.at(name) : name; }
  bool has(const std::string& name) const { return columns.contains(name); }
  std::size_t rows() const { return line.size(); }
  /// Dimensionless values. Throws InputError (file, line) when the column is missing, or a value is beyond
  /// largest_imported.
  std::vector<double> values(const std::string& name, const Scales& scales) const;
  double time_in(const Scales& scales) const;
  /// The numbers of both are the same, but for their places in files.
  bool repeats(const FrameTable& other) const;
  [[noreturn]] void refuse(std::size_t row, const std::string& key, const std::string& what,
                           const std::string& allowed = "") const;
};

/// Frames in order; none after the last.
using FrameTableSource = std::function<std::optional<FrameTable>()>;

/// Largest place, speed, force or time in units of d, sqrt(d/g) and rho0 g d: beyond, a unit is wrong or the
/// other program has lost its grains.
inline constexpr double largest_imported = 1e9;

/// What a source has to say beside its frames.
struct SourceNotes {
  std::set<std::string> unused_columns;  ///< that were there and told nothing
  std::string cut_off;                   ///< where the last frame ends too early and was left out; else empty
};

}  // namespace drumlin::particles
