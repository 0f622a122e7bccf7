#include "apps/commands/measure/maps_part.hpp"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/json/json_file.hpp"
#include "apps/process/standard_streams.hpp"
#include "coupling/core/documents/described.hpp"
#include "coupling/core/files/scratch_file.hpp"
#include "coupling/core/hdf5/field_map_file.hpp"
#include "particles/measurement/maps/field_values.hpp"
#include "particles/measurement/maps/map_measurement.hpp"

namespace drumlin::particles {
DRUMLIN_DESCRIBED(BalanceResidual, nodes, rms_x, rms_z, mean_x, mean_z, noise_x, noise_z, rms_x_blocks,
                  rms_z_blocks, rms_x_without_kinetic, rms_z_without_kinetic, rms_inertia)
DRUMLIN_DESCRIBED(MomentumBalance, bulk, flowing, slow)
DRUMLIN_DESCRIBED(LogLine, a, b, rms, nodes)
}  // namespace drumlin::particles

namespace drumlin::apps {
namespace {

using Json = nlohmann::ordered_json;

/// What grows while the snapshots are read, and what comes of it.
struct Maps {
  particles::MapReading reading;
  particles::MeasuredMaps measured;
};

/// mu_invariant of measured.json.
Json collapse_of(const particles::BulkFriction& collapse, const particles::LogLine& ci99) {
  const auto with = [](double value, double half_width) { return to_json(Scalar{"", value, half_width}); };
  return {{"a", with(collapse.invariant.a, ci99.a)},
          {"b", with(collapse.invariant.b, ci99.b)},
          {"rms", with(collapse.invariant.rms, ci99.rms)},
          {"noise", collapse.noise},
          {"nodes", collapse.invariant.nodes},
          {"share", static_cast<double>(collapse.invariant.nodes) / static_cast<double>(collapse.bulk)},
          {"ratio", collapse.ratio}};
}

void write(const particles::Measurement& measured, const PartOutput& output, const MeasureOptions& options,
           Maps& maps) {
  const particles::MapFindingOptions limits;
  FieldMap outline;
  outline.scales = measured.scales;
  outline.header = header_of_maps(measured.profiles.header);
  outline.header.kernel = spline_kernel_name;
  outline.header.kernel_width = options.map_width;
  std::optional<FieldMapWriter> file;
  maps.measured = particles::measured_maps(std::move(maps.reading), measured.place, measured.surface_z,
                                           limits, [&](const MapGrid& grid, const particles::MapRows& rows) {
                                             outline.grid = grid;
                                             if (!file) file.emplace(output.folder / "maps.h5", outline);
                                             file->add(rows.fields);
                                           });
  output.content["momentum_balance"] = maps.measured.balance;
  output.content["mu_invariant"] = collapse_of(maps.measured.friction, maps.measured.friction_ci99);
  output.content["settings"]["maps"] = {
      {"spacing", options.map_spacing}, {"kernel_width", options.map_width},
      {"least_nu", least_map_nu},       {"displacement_interval", maps.measured.displacement_interval},
      {"bulk_margin", limits.margin},   {"block", limits.block},
      {"flowing_I", limits.flowing_I},  {"mu_fit_I", {limits.I_min, limits.I_max}}};
  file->save();
}

void print(const particles::MeasuredMaps& maps) {
  const auto line = [](const char* zone, const particles::BalanceResidual& r) {
    if (r.nodes == 0) return;
    print_out(fmt::format("  {:8} {:.2f}, {:.2f} % along x, z", zone, 100 * r.rms_x, 100 * r.rms_z));
    if (std::isfinite(r.noise_x))
      print_out(fmt::format(" (their noise {:.2f}, {:.2f} %)", 100 * r.noise_x, 100 * r.noise_z));
    if (std::isfinite(r.rms_x_blocks))
      print_out(fmt::format("; means over {} d {:.2f}, {:.2f} %", particles::MapFindingOptions{}.block,
                            100 * r.rms_x_blocks, 100 * r.rms_z_blocks));
    print_out("\n");
  };
  if (std::isfinite(maps.balance.bulk.rms_x)) {  // not without weight
    print_out("momentum missing at the nodes of the maps, rms over nu g\n");
    line("bulk", maps.balance.bulk);
    line("flowing", maps.balance.flowing);
    line("slow", maps.balance.slow);
  }
  const particles::BulkFriction& fits = maps.friction;
  if (!std::isfinite(fits.invariant.rms)) return;
  print_out("mu(I) over the whole bulk\n");
  print_out(fmt::format(
      "  |tau|/p             {:.4f} + {:.4f} ln I, rms {:.4f} (noise of mu at a node {:.4f}), {} nodes\n",
      fits.invariant.a, fits.invariant.b, fits.invariant.rms, fits.noise, fits.invariant.nodes));
  print_out(fmt::format("  sigma_xz/sigma_zz   {:.4f} + {:.4f} ln I, rms {:.4f}, {} nodes\n", fits.ratio.a,
                        fits.ratio.b, fits.ratio.rms, fits.ratio.nodes));
}

}  // namespace

Part maps_part(const MeasureOptions& options) {
  // Refused before the first snapshot is read.
  (void)grid_over(0, 1, 0, 1, options.map_spacing, options.map_width);
  auto maps = std::make_shared<Maps>();
  Part part;
  part.name = "maps";
  part.figures = "measure_maps.py";
  part.reading.begin = [maps, options](const particles::MeasurementFrame& place) {
    maps->reading = particles::begun_maps(place, options.map_spacing, options.map_width,
                                          std::make_shared<ScratchFile>(options.run()));
  };
  part.reading.add = [maps](const particles::Snapshot& snapshot, const particles::FlowSnapshot& in_frame,
                            std::size_t batch) {
    particles::add_snapshot(snapshot, in_frame, batch, maps->reading);
  };
  part.write = [maps, options](const particles::Measurement& measured, const PartOutput& output) {
    write(measured, output, options, *maps);
  };
  part.print = [maps] { print(maps->measured); };
  return part;
}

}  // namespace drumlin::apps
