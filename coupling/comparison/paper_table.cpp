#include "coupling/comparison/paper_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "coupling/comparison/paper_file.hpp"
#include "coupling/core/basics/no_value.hpp"

namespace drumlin::coupling {

namespace {

bool close(double a, double b) { return std::abs(a - b) <= 0.01 * std::abs(b); }

/// Agreement asked for in each quantity; of relative ones the share of the paper's value.
struct Accepted {
  const char* name;
  bool relative;
  double difference;
};
constexpr Accepted accepted_differences[] = {
    {"theta_deg", false, 1.0},
    {"Q", true, 0.05},
    {"H", true, 0.10},
    {"lambda", true, 0.15},
    {"shear_rate", true, 0.15},
    {"I_th", true, 0.20},
    {"nu_bulk", false, 0.02},
    {"mu_a", true, 0.05},
    {"mu_b", true, 0.20},
    {"k_flowing", false, 0.1},
    {"spin_over_half_vorticity", false, 0.05},
    {"dv_over_shear", true, 0.10},
    {"domega_over_shear", true, 0.10},
    {"linear_layer_share", true, 0.15},
};

double value_of(const std::vector<PaperNumber>& numbers, const std::string& name) {
  for (const auto& number : numbers)
    if (number.name == name) return number.value;
  return no_value;
}

double accepted_difference(const PaperNumber& number) {
  if (number.half_width) return *number.half_width;
  for (const auto& accepted : accepted_differences)
    if (number.name == accepted.name)
      return accepted.relative ? accepted.difference * std::abs(number.value) : accepted.difference;
  return no_value;
}

Outcome outcome_of(double value, const PaperRow& row) {
  if (std::isnan(value) || std::isnan(row.accepted)) return Outcome::not_measured;
  return std::abs(value - row.paper.value) <= row.accepted ? Outcome::met : Outcome::missed;
}

}  // namespace

std::optional<double> paper_speed_rpm(const ProfileSet& profiles, const std::filesystem::path& folder) {
  if (profiles.header.reduced.value_or(true)) return std::nullopt;
  const Document experiment = paper_file(folder / "experiment.toml");
  const Node* drum = experiment.root.find("drum");
  const double paper_diameter_mm = number_in(drum == nullptr ? nullptr : drum->find("diameter_mm"));
  const double d = number_or_nan(profiles.header, &RunHeader::diameter_m);
  const double radius = number_or_nan(profiles.header, &RunHeader::drum_radius);
  if (!close(2e3 * radius * d, paper_diameter_mm)) return std::nullopt;
  constexpr double gravity_m_s2 = 9.81;
  const double rotation = number_or_nan(profiles.header, &RunHeader::rotation);
  const double rpm = rotation / std::sqrt(d / gravity_m_s2) * 30 / std::numbers::pi;
  for (const auto& entry : paper_entries(paper_file(folder / "rotations.toml"), "rotation")) {
    const double speed = number_in(entry.find("rotation_rpm"));
    if (close(rpm, speed)) return speed;
  }
  return std::nullopt;
}

std::vector<PaperNumber> paper_numbers(const std::filesystem::path& folder, double rotation_rpm) {
  std::vector<PaperNumber> numbers;
  const Document table = paper_file(folder / "rotations.toml");
  for (const auto& entry : paper_entries(table, "rotation")) {
    if (number_in(entry.find("rotation_rpm")) != rotation_rpm) continue;
    for (const auto* name : {"theta_deg", "Q", "H"})
      numbers.push_back(
          {name, number_in(entry.find(name)), std::nullopt, text_in(table.root.find("source")), ""});
  }
  std::vector<PaperNumber> general;
  for (const auto& entry : paper_entries(paper_file(folder / "observables.toml"), "observable")) {
    const double speed = number_in(entry.find("rotation_rpm"));
    if (!std::isnan(speed) && speed != rotation_rpm) continue;
    PaperNumber number{text_in(entry.find("name")), number_in(entry.find("value")), std::nullopt,
                       text_in(entry.find("source")), text_in(entry.find("remark"))};
    if (entry.find("half_width") != nullptr) number.half_width = number_in(entry.find("half_width"));
    (std::isnan(speed) ? general : numbers).push_back(number);
  }
  numbers.insert(numbers.end(), general.begin(), general.end());
  const double share =
      linear_layer_share(value_of(numbers, "shear_rate"), value_of(numbers, "H"), value_of(numbers, "Q"));
  if (!std::isnan(share))
    numbers.push_back({"linear_layer_share", share, std::nullopt, "from its shear rate, H and Q", ""});
  return numbers;
}

std::vector<PaperRow> paper_table(const std::vector<PaperNumber>& numbers,
                                  const std::vector<ScalarPair>& scalars) {
  std::vector<PaperRow> rows;
  for (const auto& number : numbers) {
    const auto ours = std::find_if(scalars.begin(), scalars.end(), [&](const ScalarPair& candidate) {
      return candidate.name == number.name;
    });
    if (ours == scalars.end() || (std::isnan(ours->particles) && std::isnan(ours->continuum))) continue;
    PaperRow row{number, *ours, accepted_difference(number)};
    row.particles = outcome_of(ours->particles, row);
    row.continuum = outcome_of(ours->continuum, row);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace drumlin::coupling
