#include "particles/import/import_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "coupling/common/errors.hpp"
#include "particles/import/csv_frames.hpp"
#include "particles/import/import_contacts.hpp"
#include "particles/import/lammps_frames.hpp"

namespace drumlin::particles {
namespace {

namespace fs = std::filesystem;

constexpr double same_time =
    1e-9;  // relative: times of a table of few digits are compared as they are printed

/// What the files give, before any unit is known.
struct Sources {
  FrameTableSource grains;
  std::optional<FrameTableSource> contacts;
  std::vector<std::string> files;
};

Sources sources_of(const ImportDescription& description, const fs::path& folder, UnusedColumns& unused) {
  Sources sources;
  const auto found = [&](const std::vector<std::string>& patterns) {
    const auto files = files_of(folder, patterns);
    for (const fs::path& file : files) sources.files.push_back(fs::relative(file, folder).string());
    return files;
  };
  if (const auto* lammps = std::get_if<LammpsSource>(&description.source)) {
    sources.grains = lammps_grains(found(lammps->grains), *lammps, unused);
    if (!lammps->contacts.empty())
      sources.contacts = lammps_contacts(found(lammps->contacts), *lammps, unused);
  } else {
    const auto& csv = std::get<CsvSource>(description.source);
    sources.grains = csv_frames(found(csv.grains), CsvContent::grains, csv.interval_s, unused);
    if (!csv.contacts.empty())
      sources.contacts = csv_frames(found(csv.contacts), CsvContent::contacts, csv.interval_s, unused);
  }
  return sources;
}

}  // namespace

std::vector<fs::path> import_files(const ImportDescription& description, const fs::path& folder) {
  std::vector<fs::path> files;
  const auto add = [&](const std::vector<std::string>& patterns) {
    if (patterns.empty()) return;
    const auto found = files_of(folder, patterns);
    files.insert(files.end(), found.begin(), found.end());
  };
  std::visit([&](const auto& source) { add(source.grains), add(source.contacts); }, description.source);
  return files;
}

namespace {

/// Rows that are grains, in the order of their ids; the rest are atoms of walls.
struct Rows {
  std::vector<std::size_t> grains, wall_atoms;
  std::vector<std::int64_t> id;  ///< of each row of the table
};

Rows rows_of(const FrameTable& table, const ImportDescription& description) {
  Rows rows;
  if (table.has("id")) {
    for (std::size_t row = 0; row < table.rows(); ++row) {
      const double id = table.columns.at("id").values[row];
      if (id != std::floor(id) || !(id >= 0 && id < 1e15))
        table.refuse(row, "id", fmt::format("{} is no id", id), "a whole number >= 0");
      rows.id.push_back(static_cast<std::int64_t>(id));
    }
  } else {
    rows.id.resize(table.rows());
    std::iota(rows.id.begin(), rows.id.end(), 0);
  }
  const auto* lammps = std::get_if<LammpsSource>(&description.source);
  const bool has_walls = lammps && !lammps->wall_types.empty();
  const std::vector<double> type = has_walls ? table.values("type", {1, 1, 1}) : std::vector<double>();
  for (std::size_t row = 0; row < table.rows(); ++row) {
    const bool wall = has_walls && std::find(lammps->wall_types.begin(), lammps->wall_types.end(),
                                             type[row]) != lammps->wall_types.end();
    (wall ? rows.wall_atoms : rows.grains).push_back(row);
  }
  std::sort(rows.grains.begin(), rows.grains.end(),
            [&](std::size_t a, std::size_t b) { return rows.id[a] < rows.id[b]; });
  for (std::size_t g = 1; g < rows.grains.size(); ++g)
    if (rows.id[rows.grains[g]] == rows.id[rows.grains[g - 1]])
      table.refuse(std::max(rows.grains[g], rows.grains[g - 1]), "id",
                   fmt::format("{} stands twice in one snapshot", rows.id[rows.grains[g]]));
  if (rows.grains.empty()) table.refuse(0, "", "there are no grains");
  return rows;
}

/// Units from the description; the mean diameter from the first snapshot unless it is given.
Scales scales_for(const ImportDescription& description, const FrameTable& table, const Rows& rows) {
  double diameter_m = description.grains.mean_diameter_m.value_or(0);
  if (!description.grains.mean_diameter_m) {
    const std::vector<double> radius = table.values("radius", {1, 1, 1});
    if (!table.columns.at("radius").in_si)
      throw InputError("grains.mean_diameter_m: is needed, for the radii of " + table.file + " have no unit");
    for (const std::size_t row : rows.grains)
      diameter_m += 2 * radius[row] / static_cast<double>(rows.grains.size());
    if (!(diameter_m > 0)) table.refuse(0, "radius", "the mean radius is not above 0");
  }
  return drumlin::scales_of(diameter_m, description.gravity.acceleration_m_s2,
                            description.grains.density_kg_m3);
}

/// The state that does not come from the files.
Snapshot frame_of(const ImportDescription& description, const Scales& scales) {
  Snapshot s;
  s.scales = scales;
  s.time_step = description.time_step_s.value_or(scales.time_s) / scales.time_s;
  const double direction = description.gravity.direction_deg * std::numbers::pi / 180;
  s.gravity_x = std::cos(direction);
  s.gravity_z = std::sin(direction);
  if (description.drum) {
    s.container_x = description.drum->center_m[0] / scales.length_m;
    s.container_z = description.drum->center_m[1] / scales.length_m;
    s.container_radius = description.drum->radius_m / scales.length_m;
    s.wall_spin = description.drum->speed_rpm * 2 * std::numbers::pi / 60 * scales.time_s;
  }
  if (description.periodic_x) s.period_x = description.periodic_x->length_m / scales.length_m;
  return s;
}

void check_flat(const FrameTable& table, const Snapshot& s, const Rows& rows) {
  if (!table.has("third")) return;
  const std::vector<double> third = table.values("third", s.scales);
  for (const std::size_t row : rows.grains)
    if (std::abs(third[row] - third[rows.grains.front()]) > s.radius.front())
      table.refuse(row, "", "the grains lie in space, not in a plane", "one layer of grains");
}

void add_grains(const FrameTable& table, const Rows& rows, Snapshot& s) {
  const auto add = [&](const char* name, std::vector<double>& target, double sign = 1) {
    const std::vector<double> values = table.values(name, s.scales);
    for (const std::size_t row : rows.grains) target.push_back(sign * values[row]);
  };
  add("x", s.x), add("z", s.z), add("v_x", s.v_x), add("v_z", s.v_z), add("radius", s.radius);
  if (table.has("spin_clockwise")) {
    add("spin_clockwise", s.spin);
  } else if (table.has("spin_anticlockwise")) {
    add("spin_anticlockwise", s.spin, -1);
  }
  for (std::size_t g = 0; g < s.x.size(); ++g) {
    const std::size_t row = rows.grains[g];
    if (!(s.radius[g] > 0)) table.refuse(row, "radius", "is not above 0", "> 0");
    if (s.container_radius > 0 &&
        std::hypot(s.x[g] - s.container_x, s.z[g] - s.container_z) > s.container_radius)
      table.refuse(row, "x, z", "the grain lies outside of the drum",
                   "centre, radius and units that fit the drum");
  }
  check_flat(table, s, rows);
}

FrameBodies bodies_of(const FrameTable& table, const Rows& rows, const Scales& scales) {
  FrameBodies bodies;
  for (std::size_t g = 0; g < rows.grains.size(); ++g)
    bodies.grain[rows.id[rows.grains[g]]] = static_cast<std::int32_t>(g);
  const std::vector<double> x = table.values("x", scales), z = table.values("z", scales);
  for (const std::size_t row : rows.wall_atoms) bodies.wall_atoms[rows.id[row]] = {x[row], z[row]};
  return bodies;
}

/// The grains of one snapshot are those of the one before.
void check_same_grains(const std::vector<std::int64_t>& before, const std::vector<std::int64_t>& now,
                       const FrameTable& table) {
  if (before.empty() || before == now) return;
  const auto missing = [&](const auto& from, const auto& in) {
    for (const std::int64_t id : from)
      if (!std::binary_search(in.begin(), in.end(), id)) return id;
    return from.front();
  };
  const bool lost = now.size() <= before.size();
  table.refuse(table.rows(), "id",
               fmt::format("grain {} {}", lost ? missing(before, now) : missing(now, before),
                           lost ? "is gone" : "was not there before"),
               "the same grains in every snapshot, or grains.may_change = true");
}

/// The frame of contacts that belongs to a time. Frames without a time belong one to one; an instant that a
/// table with times does not name has no contacts.
class ContactFrames {
 public:
  explicit ContactFrames(FrameTableSource source) : source_(std::move(source)), waiting_(source_()) {}

  std::optional<FrameTable> at(double time, const FrameTable& grains, const Scales& scales) {
    if (!waiting_) {
      if (timed_) return std::nullopt;
      grains.refuse(grains.rows(), "contacts", "there is no frame of contacts for this snapshot",
                    "one for each");
    }
    timed_ = waiting_->time.has_value();
    if (timed_) {
      const double own = waiting_->time_in(scales);
      const double tolerance = same_time * std::max(1.0, std::abs(time));
      if (own < time - tolerance)
        waiting_->refuse(waiting_->rows(), "time", "there is no snapshot of grains at this time");
      if (own > time + tolerance) return std::nullopt;
    }
    std::optional<FrameTable> frame = std::move(waiting_);
    waiting_ = source_();
    return frame;
  }
  void check_used_up() const {
    if (waiting_) waiting_->refuse(waiting_->rows(), "contacts", "there is no snapshot of grains for these");
  }

 private:
  FrameTableSource source_;
  std::optional<FrameTable> waiting_;
  bool timed_ = false;
};

/// Contacts push, in sum: what pulls acts on the other grain of the pair.
void check_push(const Snapshot& s, const FrameTable& table) {
  double sum = 0;
  for (const SnapshotContact& contact : s.contacts) sum += contact.impulse_n;
  if (sum < 0)
    table.refuse(table.rows(), "contacts", "the contacts of this snapshot pull, in sum",
                 "forces on the first grain of a contact, normals towards it");
}

}  // namespace

ImportReport import_run(const ImportDescription& description, const fs::path& folder,
                        const std::function<void(const Snapshot&)>& sink) {
  UnusedColumns unused;
  Sources sources = sources_of(description, folder, unused);
  std::optional<ContactFrames> contacts;
  if (sources.contacts) contacts.emplace(*sources.contacts);

  ImportReport report;
  std::vector<std::int64_t> ids;
  double first_time = 0, last_time = 0;
  const double turned_before =
      description.drum
          ? std::copysign(2 * std::numbers::pi * description.drum->turns_before, description.drum->speed_rpm)
          : 0;
  while (const std::optional<FrameTable> table = sources.grains()) {
    const Rows rows = rows_of(*table, description);
    if (report.snapshots == 0) report.scales = scales_for(description, *table, rows);
    if (!table->time)
      table->refuse(table->rows(), "time_s", "the time is not known",
                    "a column time_s or time, or csv.interval_s");
    const double time = table->time_in(report.scales);
    if (report.snapshots == 0) first_time = time;
    if (report.snapshots > 0 && !(time > last_time))
      table->refuse(0, "time_s",
                    fmt::format("{:.9g} s does not go on from {:.9g} s", time * report.scales.time_s,
                                last_time * report.scales.time_s),
                    "times that ascend");
    last_time = time;

    std::vector<std::int64_t> own_ids;
    for (const std::size_t row : rows.grains) own_ids.push_back(rows.id[row]);
    if (!description.grains.may_change) check_same_grains(ids, own_ids, *table);
    ids = std::move(own_ids);

    Snapshot s = frame_of(description, report.scales);
    s.step = static_cast<std::int64_t>(++report.snapshots);
    s.time = time;
    s.wall_angle = turned_before + s.wall_spin * (time - first_time);
    add_grains(*table, rows, s);
    s.contacts_known = contacts.has_value();
    if (contacts)
      if (const auto frame = contacts->at(time, *table, report.scales)) {
        add_contacts(*frame, bodies_of(*table, rows, report.scales), s);
        check_push(s, *frame);
      }
    report.grains = s.x.size();
    report.contacts += s.contacts.size();
    report.with_spin = !s.spin.empty();
    sink(s);
  }
  if (report.snapshots == 0) throw InputError("the files hold no snapshot");
  if (contacts) contacts->check_used_up();
  report.with_contacts = contacts.has_value();
  report.first_time_s = first_time * report.scales.time_s;
  report.last_time_s = last_time * report.scales.time_s;
  report.files = std::move(sources.files);
  report.unused_columns.assign(unused.begin(), unused.end());
  return report;
}

}  // namespace drumlin::particles
