#include "apps/commands/expected_output.hpp"

#include <fmt/format.h>

#include <cmath>
#include <system_error>

namespace drumlin::apps {
namespace {

// docs/formats/snapshot.md; HDF5's own bookkeeping; a line of log.csv; a checkpoint's share of a grain.
constexpr double contacts_per_grain = 1.7, bookkeeping = 18e3, log_line_bytes = 100,
                 checkpoint_per_grain = 106;

std::string megabytes(double bytes) {
  const double mb = bytes * 1e-6;
  return mb < 10    ? fmt::format("{:.2g} MB", mb)
         : mb < 1e4 ? fmt::format("{:.0f} MB", mb)
                    : fmt::format("{:.0f} GB", mb * 1e-3);
}

}  // namespace

ExpectedOutput expected_output(const particles::Scene& scene, std::size_t grains, std::size_t snapshots,
                               std::int64_t steps) {
  const double n = static_cast<double>(grains);
  const double per_grain = 40 + (scene.output.velocity_window_s > 0 ? 16 : 0) + (scene.effects.spin ? 8 : 0);
  const double per_contact = scene.effects.friction ? 32 : 24;
  ExpectedOutput expected;
  expected.snapshot = bookkeeping + n * (per_grain + contacts_per_grain * per_contact);
  expected.snapshots = expected.snapshot * static_cast<double>(snapshots);
  expected.log = log_line_bytes * static_cast<double>(steps) / scene.output.log_every_steps;
  expected.checkpoints = 2 * checkpoint_per_grain * n;
  return expected;
}

std::string expected_output_text(const ExpectedOutput& expected) {
  const double count = expected.snapshot > 0 ? std::round(expected.snapshots / expected.snapshot) : 0;
  return fmt::format("about {}: {:.0f} snapshots of {}, log.csv of {}, checkpoints of {}",
                     megabytes(expected.all()), count, megabytes(expected.snapshot), megabytes(expected.log),
                     megabytes(expected.checkpoints));
}

std::string room_warning(const ExpectedOutput& expected, const std::filesystem::path& folder) {
  std::error_code unknown;
  std::filesystem::path place = std::filesystem::absolute(folder, unknown);
  while (!std::filesystem::exists(place, unknown) && place.has_parent_path() && place != place.parent_path())
    place = place.parent_path();
  const auto space = std::filesystem::space(place, unknown);
  if (unknown || static_cast<double>(space.available) >= expected.all()) return "";
  return fmt::format("about {} will be written, and {} has room for {}", megabytes(expected.all()),
                     place.string(), megabytes(static_cast<double>(space.available)));
}

}  // namespace drumlin::apps
