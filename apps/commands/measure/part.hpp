#pragma once
// The parts of `drumlin measure` that stand beside the profiles: what is not named is neither computed nor
// stored.
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/commands/measure/measure.hpp"
#include "particles/measurement/measurement.hpp"

namespace drumlin::apps {

/// Where a part leaves its results.
struct PartOutput {
  std::filesystem::path folder;     ///< RUN/measured
  nlohmann::ordered_json& content;  ///< of measured.json
  bool reduced = false;
};

/// A part that reads the snapshots itself.
struct Part {
  std::string name;
  particles::MeasurementPart reading;
  /// Writes its files and its keys of measured.json; draws nothing.
  std::function<void(const particles::Measurement&, const PartOutput&)> write;
  std::function<void()> print;  ///< what it found, in lines after the scalars; may be empty
  /// Script of apps/figures that draws its figures once all files are there; empty: none. It is called with
  /// the folder, as measure_figures.py is.
  std::string figures;
};

/// Names that `--parts` takes, in the order of the documentation; all of them are the default.
const std::vector<std::string>& part_names();
/// Throws InputError when a name is not one of part_names().
void check_parts(const std::vector<std::string>& names);
bool names_part(const MeasureOptions& options, const std::string& name);

/// The parts among those named that read the snapshots themselves.
std::vector<Part> reading_parts(const MeasureOptions& options);

}  // namespace drumlin::apps
