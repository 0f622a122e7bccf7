#include "coupling/calibration/run_evidence.hpp"

#include <utility>

namespace drumlin::coupling {
namespace {

template <class Selection>
Selection within(const InertialSelection& range) {
  Selection selection;
  selection.I_min = range.I_min.value_or(selection.I_min);
  selection.I_max = range.I_max.value_or(selection.I_max);
  return selection;
}

}  // namespace

void add_blocks(RunEvidence& run, FieldMap map, const InertialSelection& range) {
  run.blocks = law_points(map, within<BlockSelection>(range));
  run.map = std::move(map);
}

void add_layers(RunEvidence& run, const ProfileSet& profiles, const InertialSelection& range) {
  const auto selection = within<LayerSelection>(range);
  run.layers = friction_points(profiles, selection);
  run.ratios = friction_points(profiles, selection, "k");
}

}  // namespace drumlin::coupling
