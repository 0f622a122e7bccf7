#pragma once
// A profile: columns of numbers over the layers of one place, with its header and its file.
#include <filesystem>
#include <string>
#include <vector>

#include "coupling/core/results/run_header.hpp"

namespace drumlin {

/// One quantity over the layers of a profile; NaN marks a layer where it was not computed.
struct ProfileColumn {
  std::string name;
  std::vector<double> value;
  std::vector<double> ci99;  ///< half width of the 99 % interval; empty when the quantity has none
};

/// Profile at one position x. z counts from the free surface (negative below it), one entry per layer,
/// ascending; dimensionless (docs/conventions.md), in the frame of the drum. Names of the columns, the same
/// on both sides: docs/formats/quantities.md.
struct ProfileSet {
  std::vector<double> z;
  std::vector<ProfileColumn> columns;
  RunHeader header;  ///< settings, provenance: one "# key = value" line each

  const ProfileColumn* find(const std::string& name) const;
  const ProfileColumn& column(const std::string& name) const;  ///< throws InputError if it is missing
};

/// Linear in z between two layers; at a layer its own value; NaN outside of them or beside a missing value.
double interpolated(const std::vector<double>& z, const std::vector<double>& value, double at);

/// The lines of a table as profiles.csv has them: names, of which the first is the coordinate's, then one
/// line per layer.
std::string profile_table(const ProfileSet& profiles, const std::string& coordinate = "z");

/// What the columns are, a line "# column NAME = UNIT: MEANING" for each quantity (quantities.hpp).
std::string column_lines(const ProfileSet& profiles);

/// profiles.csv, version 1: "# drumlin-profiles-1", "# key = value" lines, those of columns, a line of names
/// (z, then each column and, if it has one, NAME_ci99), then one line per layer. NaN is written as an empty
/// field.
void write_profiles(const std::filesystem::path& file, const ProfileSet& profiles);
/// Throws InputError (file, line) on what it does not understand, another version, unequal lengths, unsorted
/// z.
ProfileSet read_profiles(const std::filesystem::path& file);

}  // namespace drumlin
