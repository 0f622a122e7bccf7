#include "particles/measurement/forces/force_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "particles/measurement/forces/force_anisotropy.hpp"
#include "particles/measurement/forces/force_distribution.hpp"
#include "particles/measurement/frame/intervals.hpp"

namespace drumlin::particles {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Fewer contacts in a layer, over all snapshots, give no mean force.
constexpr double least_contacts = 30;

/// Sums of the whole run, and without one batch each.
template <class Sums>
struct Choices {
  Sums total;
  std::vector<Sums> rest;  ///< empty with fewer than two batches

  explicit Choices(const std::vector<Sums>& batches) : total(batches.front()) {
    for (std::size_t b = 1; b < batches.size(); ++b) total += batches[b];
    for (std::size_t b = 0; b < batches.size() && batches.size() > 1; ++b)
      (rest.emplace_back(total)) -= batches[b];
  }
};

/// Nearest of the angles that stand for the same direction.
double unwrapped(double angle_deg, double near_deg) {
  return angle_deg - 180 * std::round((angle_deg - near_deg) / 180);
}

/// What `scalars_of` reads off the sums, with intervals; counts have none.
template <class Sums, class ScalarsOf>
ScalarSet with_intervals(const Choices<Sums>& choices, const ScalarsOf& scalars_of) {
  ScalarSet result = scalars_of(choices.total);
  std::vector<ScalarSet> rest;
  for (const Sums& one : choices.rest) rest.push_back(scalars_of(one));
  std::vector<double> values(rest.size());
  for (std::size_t s = 0; s < result.scalars.size(); ++s) {
    Scalar& scalar = result.scalars[s];
    if (scalar.name == "contacts") continue;
    for (std::size_t b = 0; b < rest.size(); ++b) {
      values[b] = rest[b].scalars[s].value;
      if (scalar.name.ends_with("_deg")) values[b] = unwrapped(values[b], scalar.value);
    }
    scalar.ci99 = jackknife_ci99(values);
  }
  return result;
}

void append(ScalarSet& set, const ScalarSet& more) {
  set.scalars.insert(set.scalars.end(), more.scalars.begin(), more.scalars.end());
}

/// One row per bin; value_of(sums, bin) and count_of(sums, bin) read it off.
template <class Sums, class EdgeOf, class ValueOf, class CountOf>
void add_rows(const Choices<Sums>& choices, const std::string& quantity, std::size_t bins,
              const EdgeOf& edge_of, const ValueOf& value_of, const CountOf& count_of,
              std::vector<DistributionRow>& rows) {
  std::vector<double> values(choices.rest.size());
  for (std::size_t k = 0; k < bins; ++k) {
    for (std::size_t b = 0; b < values.size(); ++b) values[b] = value_of(choices.rest[b], k);
    rows.push_back({quantity, edge_of(k), edge_of(k + 1), value_of(choices.total, k), jackknife_ci99(values),
                    count_of(choices.total, k)});
  }
}

/// Probability density from the numbers in the bins of one histogram.
template <class Histogram, class EdgeOf>
void add_density(const Choices<DistributionSums>& choices, const std::string& quantity,
                 Histogram DistributionSums::*histogram, const EdgeOf& edge_of,
                 std::vector<DistributionRow>& rows) {
  const auto count_of = [=](const DistributionSums& sums, std::size_t k) { return (sums.*histogram)[k]; };
  const auto value_of = [&](const DistributionSums& sums, std::size_t k) {
    return count_of(sums, k) / (sums.contacts * (edge_of(k + 1) - edge_of(k)));
  };
  add_rows(choices, quantity, (choices.total.*histogram).size(), edge_of, value_of, count_of, rows);
}

double ratio_edge(std::size_t bin) {
  return bin == 0 ? 0 : (static_cast<double>(bin) - 0.5) * RatioBins::width;
}

void add_distributions(const Choices<DistributionSums>& choices, std::vector<DistributionRow>& rows) {
  add_density(choices, "f_n", &DistributionSums::normal, ForceBins::edge, rows);
  add_density(choices, "f_t", &DistributionSums::tangential, ForceBins::edge, rows);
  add_density(choices, "f_t_over_f_n", &DistributionSums::ratio, ratio_edge, rows);
}

void add_directions(const Choices<DirectionSums>& choices, std::vector<DistributionRow>& rows) {
  constexpr double width_deg = 180.0 / DirectionSums::bins;
  const auto edge_of = [](std::size_t k) { return static_cast<double>(k) * width_deg; };
  const auto count_of = [](const DirectionSums& sums, std::size_t k) { return sums.count[k]; };
  // A contact shows in two opposite directions: the density per rad is counted over the full circle.
  add_rows(
      choices, "contacts_of_direction", DirectionSums::bins, edge_of,
      [](const DirectionSums& sums, std::size_t k) {
        return sums.count[k] / sums.contacts * DirectionSums::bins / (2 * std::numbers::pi);
      },
      count_of, rows);
  const auto mean_of = [](double sum, double count) { return count > 0.5 ? sum / count : none; };
  add_rows(
      choices, "f_n_of_direction", DirectionSums::bins, edge_of,
      [&](const DirectionSums& sums, std::size_t k) { return mean_of(sums.normal[k], sums.count[k]); },
      count_of, rows);
  add_rows(
      choices, "f_t_of_direction", DirectionSums::bins, edge_of,
      [&](const DirectionSums& sums, std::size_t k) { return mean_of(sums.tangential[k], sums.count[k]); },
      count_of, rows);
}

/// Mean normal force over depth.
class MeanForce {
 public:
  MeanForce(const LayerGrid& grid, const std::vector<Choices<DirectionSums>>& layers) {
    for (std::size_t l = 0; l < layers.size(); ++l)
      if (const DirectionSums& sums = layers[l].total; sums.contacts >= least_contacts) {
        z_.push_back(grid.z_of(l));
        mean_.push_back(sums.normal_sum / sums.contacts);
      }
  }
  bool known() const { return !z_.empty(); }
  double at(double z) const {
    const auto above = static_cast<std::size_t>(std::upper_bound(z_.begin(), z_.end(), z) - z_.begin());
    if (above == 0) return mean_.front();
    if (above == z_.size()) return mean_.back();
    const double share = (z - z_[above - 1]) / (z_[above] - z_[above - 1]);
    return mean_[above - 1] + share * (mean_[above] - mean_[above - 1]);
  }

 private:
  std::vector<double> z_, mean_;
};

std::vector<Choices<DirectionSums>> layer_choices(const LayerGrid& grid,
                                                  const std::vector<ContactForces>& batches) {
  std::vector<std::vector<DirectionSums>> sums(grid.layers(), std::vector<DirectionSums>(batches.size()));
  for (std::size_t b = 0; b < batches.size(); ++b)
    batches[b].between_grains.each([&](const ContactForce& contact) {
      sums[std::min(grid.layers() - 1, layer_of(grid, contact.z))][b].add(contact, 1);
    });
  std::vector<Choices<DirectionSums>> layers;
  for (const auto& of_batches : sums) layers.emplace_back(of_batches);
  return layers;
}

ProfileSet layer_columns(const LayerGrid& grid, const std::vector<Choices<DirectionSums>>& layers,
                         double surface_z) {
  ProfileSet profiles;
  const auto holds = [](const Choices<DirectionSums>& layer) { return layer.total.contacts > 0; };
  const auto first = std::find_if(layers.begin(), layers.end(), holds);
  const auto end = std::find_if(layers.rbegin(), layers.rend(), holds).base();
  for (auto layer = first; layer < end; ++layer) {
    profiles.z.push_back(grid.z_of(static_cast<std::size_t>(layer - layers.begin())) - surface_z);
    const ScalarSet found = with_intervals(*layer, direction_scalars);
    const bool enough = layer->total.contacts >= least_contacts;
    profiles.columns.resize(found.scalars.size());
    for (std::size_t s = 0; s < found.scalars.size(); ++s) {
      const Scalar& scalar = found.scalars[s];
      ProfileColumn& column = profiles.columns[s];
      column.name = scalar.name;
      column.value.push_back(enough || scalar.name == "contacts" ? scalar.value : none);
      if (scalar.ci99) column.ci99.push_back(enough ? *scalar.ci99 : none);
    }
  }
  return profiles;
}

/// Number of contacts, mean of f_n and of |f_t|: the forces as they are.
ScalarSet mean_scalars(const DirectionSums& sums) {
  ScalarSet set = direction_scalars(sums);
  set.scalars.resize(3);
  return set;
}

/// The same without those, of forces over their mean.
ScalarSet normalised_scalars(const DirectionSums& sums) {
  ScalarSet set = direction_scalars(sums);
  set.scalars.erase(set.scalars.begin(), set.scalars.begin() + 3);
  return set;
}

/// A zone of contacts between grains.
void add_zone(const std::vector<ContactForces>& batches, const MeanForce& mean, const ForceSettings& settings,
              ForceZone zone, std::vector<ForceZone>& zones) {
  const double bottom = zone.z_from + settings.surface_z, top = zone.z_to + settings.surface_z;
  const auto for_each_contact = [&](const auto& action) {
    for (std::size_t b = 0; b < batches.size(); ++b)
      batches[b].between_grains.each([&](const ContactForce& contact) {
        if (contact.z >= bottom && contact.z < top) action(b, contact);
      });
  };
  std::vector<DirectionSums> raw(batches.size()), directions(batches.size());
  std::vector<DistributionSums> local(batches.size()), common(batches.size());
  for_each_contact([&](std::size_t b, const ContactForce& contact) {
    const double scale = 1 / mean.at(contact.z);
    raw[b].add(contact, 1);
    directions[b].add(contact, scale);
    local[b].add(contact, scale, settings.friction_grains);
  });
  const Choices<DirectionSums> raw_choices(raw), direction_choices(directions);
  if (raw_choices.total.contacts < least_contacts) return;
  const double common_scale = raw_choices.total.contacts / raw_choices.total.normal_sum;
  for_each_contact([&](std::size_t b, const ContactForce& contact) {
    common[b].add(contact, common_scale, std::nullopt);
  });
  const Choices<DistributionSums> local_choices(local), common_choices(common);

  zone.scalars = with_intervals(raw_choices, mean_scalars);
  append(zone.scalars, with_intervals(direction_choices, normalised_scalars));
  append(zone.scalars, with_intervals(local_choices, [&](const DistributionSums& sums) {
           return distribution_scalars(sums, settings.friction_grains);
         }));
  Scalar zone_mean = with_intervals(common_choices, [](const DistributionSums& sums) {
                       return distribution_scalars(sums, std::nullopt);
                     }).scalars.front();
  zone_mean.name += "_zone_mean";
  zone.scalars.scalars.push_back(zone_mean);
  add_distributions(local_choices, zone.rows);
  add_density(common_choices, "f_n_zone_mean", &DistributionSums::normal, ForceBins::edge, zone.rows);
  add_directions(direction_choices, zone.rows);
  zones.push_back(std::move(zone));
}

/// The contacts with walls, over their own mean: they lie at one depth, and their directions are the wall's.
void add_wall_zone(const std::vector<ContactForces>& batches, const ForceSettings& settings,
                   std::vector<ForceZone>& zones) {
  std::vector<DirectionSums> raw(batches.size());
  for (std::size_t b = 0; b < batches.size(); ++b)
    batches[b].with_walls.each([&](const ContactForce& contact) { raw[b].add(contact, 1); });
  const Choices<DirectionSums> raw_choices(raw);
  if (raw_choices.total.contacts < least_contacts) return;
  const double scale = raw_choices.total.contacts / raw_choices.total.normal_sum;
  std::vector<DistributionSums> sums(batches.size());
  for (std::size_t b = 0; b < batches.size(); ++b)
    batches[b].with_walls.each(
        [&](const ContactForce& contact) { sums[b].add(contact, scale, settings.friction_walls); });
  const Choices<DistributionSums> choices(sums);
  ForceZone zone{"wall", settings.wall_z, settings.wall_z, with_intervals(raw_choices, mean_scalars), {}};
  append(zone.scalars, with_intervals(choices, [&](const DistributionSums& one) {
           return distribution_scalars(one, settings.friction_walls);
         }));
  add_distributions(choices, zone.rows);
  zones.push_back(std::move(zone));
}

}  // namespace

ForceStatistics force_statistics(const LayerGrid& grid, const std::vector<ContactForces>& batches,
                                 const ForceSettings& settings) {
  ForceStatistics result;
  if (batches.empty() || grid.layers() == 0) return result;
  const auto layers = layer_choices(grid, batches);
  result.layers = layer_columns(grid, layers, settings.surface_z);
  const MeanForce mean(grid, layers);
  if (mean.known()) {
    const double bottom = settings.wall_z + settings.wall_margin;
    const auto add = [&](const char* name, double from, double to) {
      if (from < to) add_zone(batches, mean, settings, {name, from, to, {}, {}}, result.zones);
    };
    add("flowing", -settings.H, -settings.surface_margin);
    add("static", bottom, -settings.H - settings.interface_gap);
    add("bulk", bottom, -settings.surface_margin);
  }
  add_wall_zone(batches, settings, result.zones);
  return result;
}

}  // namespace drumlin::particles
