#pragma once
// Table of the paper's numbers (data/paper) beside those of both sides.
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "coupling/comparison/comparison.hpp"

namespace drumlin::coupling {

/// A number of the paper that holds at one speed of rotation, in d, sqrt(d/g), rho0 g d.
struct PaperNumber {
  std::string name;  ///< key of measured.json
  double value = 0;
  std::optional<double> half_width;  ///< the uncertainty that the paper states
  std::string source;
  std::string remark;
};

/// The paper's speed (rpm) whose drum a profile's header describes: drum of 450 mm, full size, one of six
/// speeds, each to 1 %; in gravity of 9.81 m/s2. Nothing for another drum. `folder` is data/paper; throws
/// InputError on its files.
std::optional<double> paper_speed_rpm(const ProfileSet& profiles, const std::filesystem::path& folder);

/// Table I at this speed, then the observables; one that is stated for this very speed stands before one for
/// all; last, where the paper gives a shear rate, the linear_layer_share of its own numbers.
std::vector<PaperNumber> paper_numbers(const std::filesystem::path& folder, double rotation_rpm);

struct PaperRow {
  PaperNumber paper;
  ScalarPair ours;
  double accepted = 0;                        ///< largest difference that counts as agreement, absolute
  Outcome particles = Outcome::not_measured;  ///< whether |particles - paper| <= accepted
  Outcome continuum = Outcome::not_measured;
};

/// One row per number of the paper that one of the sides has. The accepted difference is the project's own
/// choice, written down in docs/formats/comparison.md before the first run; the paper states none but for
/// lambda.
std::vector<PaperRow> paper_table(const std::vector<PaperNumber>& numbers,
                                  const std::vector<ScalarPair>& scalars);

}  // namespace drumlin::coupling
