#pragma once
// Description of a run of another program: what its files do not say (docs/formats/import.md).
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "coupling/core/documents/key_lister.hpp"
#include "particles/scene/scene.hpp"

namespace drumlin::particles {

/// Tables with a line of column names, fields between commas, or with names given here, fields between spaces
/// or commas. Files count from the folder of the description; "*" in a name stands for any text.
struct CsvSource {
  std::vector<std::string> grains;
  std::vector<std::string> columns;  ///< the names, of files of grains that have no line of them
  std::vector<std::string> heading;  ///< names of the numbers above each snapshot, one of them "count"
  std::vector<std::string> contacts;
  std::optional<double> interval_s;
};

enum class DumpPlane { xy, xz };
constexpr auto names_of(DumpPlane) { return std::array{"xy", "xz"}; }
enum class ForceOn { first, second };
constexpr auto names_of(ForceOn) { return std::array{"first", "second"}; }
enum class ImportedVelocities { given, displacements };
constexpr auto names_of(ImportedVelocities) { return std::array{"given", "displacements"}; }

/// Files of any format that is known by its first bytes.
struct FilesSource {
  std::vector<std::string> grains;
  std::vector<std::string> columns;  ///< names behind attrs of Yade's text
  DumpPlane plane = DumpPlane::xy;
  std::optional<double> step_s, interval_s;
  std::optional<double> length_unit_m, time_unit_s, mass_unit_kg;
  std::vector<double> wall_types;
  std::vector<std::string> contacts;
  std::vector<std::string> contact_ids;
  std::vector<std::string> contact_forces;
  std::vector<double> wall_ids;
  ForceOn force_on = ForceOn::first;
  std::optional<double> depth_m;
};

/// The same, of text dumps of LAMMPS and of programs that write its format.
struct LammpsSource : FilesSource {};

struct ImportedGrains {
  double density_kg_m3 = 0;
  std::optional<double> mean_diameter_m;
  bool may_change = false;
  ImportedVelocities velocities = ImportedVelocities::given;
};

struct ImportedDrum {
  std::array<double, 2> center_m{0, 0};
  double radius_m = 0;
  double speed_rpm = 0;
  double turns_before = 0;
};

struct ImportedPeriod {
  double length_m = 0;
};

struct ImportDescription {
  std::string title;
  bool reduced = false;
  int dimensions = 2;  ///< 3: spheres
  std::variant<CsvSource, LammpsSource, FilesSource> source;
  ImportedGrains grains;
  Gravity gravity;
  std::optional<ImportedDrum> drum;
  std::optional<ImportedPeriod> periodic_x, periodic_y;
  std::optional<double> time_step_s;
};

/// Throws InputError with every fault of the file: place, key, what is allowed.
ImportDescription read_import_description(const std::filesystem::path& file,
                                          const std::vector<std::string>& overrides = {});
/// As TOML, with all defaults.
std::string import_description_text(const ImportDescription& description);
/// Its keys, as `drumlin import --keys` lists them.
std::vector<KeyRow> import_keys();

/// The files of a list of names and patterns, in its order; those of one pattern in the order of their names,
/// numbers in them by value. Throws InputError when a name or pattern finds none.
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder,
                                            const std::vector<std::string>& patterns);

}  // namespace drumlin::particles
