#pragma once
// Comparison of slices and of whole maps, by the definitions used at the centre.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "coupling/comparison/field_errors.hpp"
#include "coupling/comparison/registration.hpp"

namespace drumlin::coupling {

struct ZoneErrors {
  Zone zone;  ///< of a map: from and to are NaN
  FieldErrors errors;
};
struct FieldComparison {
  FieldOverlay overlay;
  std::vector<ZoneErrors> zones;
};

/// What a side has beside its centre.
struct SideFields {
  std::map<double, ProfileSet> slices;  ///< by position x
  std::optional<FieldMap> maps;
};

struct SliceComparison {
  double position = 0;  ///< x, d
  double H = 0;         ///< of the particles in this slice; NaN where there is no flowing layer
  double offset = 0;    ///< added to the second side's z
  std::vector<FieldComparison> fields;
};

/// A zone of a map: some of its nodes.
struct MapZone {
  std::string name;
  std::vector<std::size_t> nodes;
};

struct MapComparison {
  MapGrid grid;       ///< of the particles
  double offset = 0;  ///< added to the second side's z
  std::vector<MapZone> zones;
  std::vector<FieldComparison> fields;
};

/// A part, or why there is none.
template <class Part>
struct PartOrReason {
  Part part;
  std::string missing;  ///< empty: the part is there
};

/// Every slice of the first side (of a continuum: at 0, 0.3 and 0.6 of half the chord, 2 d wide, through its
/// maps) against the slice of the second within 0.5 d, or else a profile through its maps. z is the first
/// side's, from its surface in that slice; each slice is registered by itself.
PartOrReason<std::vector<SliceComparison>> compared_slices(const SideFields& first, const SideFields& second,
                                                           Registration by, const ZoneOptions& options);

/// Zones of a map, by the first side: nodes at least surface_margin below the place where nu crosses 0.7 from
/// above (where it ends, if it never does) and wall_margin inside the drum: flowing (I >= flowing_I),
/// static (the others), all; upstream, middle, downstream: thirds of the surface's chord.
std::vector<MapZone> map_zones(const FieldMap& map, const ZoneOptions& options);

/// Every node of the first side's maps; the second is interpolated bilinearly at the same place.
PartOrReason<MapComparison> compared_maps(const SideFields& first, const SideFields& second, Registration by,
                                          const ZoneOptions& options);

/// Maps of both sides at the first one's nodes, as they stand: NAME_particles and NAME_continuum with their
/// half widths for v_x, v_z, strain_rate, sigma_xx, sigma_zz, sigma_xz, p, I, mu, k, axis_angle_deg; `zone`
/// (0: in none, 1: static, 2: flowing) and `noise` (1: the shear rate's interval leaves its sign open). Both
/// sides must have maps.
FieldMap overlaid_maps(const FieldMap& first, const FieldMap& second, const MapComparison& comparison);

}  // namespace drumlin::coupling
