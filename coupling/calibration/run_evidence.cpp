#include "coupling/calibration/run_evidence.hpp"

namespace drumlin::coupling {
namespace {

constexpr double bulk_margin = 4;  // that of the means over a bulk in measured.json

template <class Selection>
Selection within(const InertialSelection& range) {
  Selection selection;
  selection.I_min = range.I_min.value_or(selection.I_min);
  selection.I_max = range.I_max.value_or(selection.I_max);
  return selection;
}

}  // namespace

void add_blocks(RunEvidence& run, const FieldMap& map, const InertialSelection& range) {
  run.blocks = law_points(map, within<BlockSelection>(range));
}

void add_layers(RunEvidence& run, const ProfileSet& profiles, const InertialSelection& range) {
  auto selection = within<LayerSelection>(range);
  run.in_layers = !(number_or_nan(profiles.header, &RunHeader::drum_radius) > 0);
  if (run.in_layers) {
    selection.surface_margin = selection.wall_margin = bulk_margin;
    selection.I_max = range.I_max.value_or(1);
  }
  run.layers = friction_points(profiles, selection);
  run.ratios = friction_points(profiles, selection, "k");
}

}  // namespace drumlin::coupling
