#include "particles/import/import_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "coupling/core/basics/errors.hpp"
#include "particles/import/csv_frames.hpp"
#include "particles/import/import_contacts.hpp"
#include "particles/import/import_grains.hpp"
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

struct Notes {
  SourceNotes grains, contacts;
};

Sources sources_of(const ImportDescription& description, const fs::path& folder, Notes& notes) {
  Sources sources;
  const auto found = [&](const std::vector<std::string>& patterns) {
    const auto files = files_of(folder, patterns);
    for (const fs::path& file : files) sources.files.push_back(fs::relative(file, folder).string());
    return files;
  };
  if (const auto* lammps = std::get_if<LammpsSource>(&description.source)) {
    sources.grains = lammps_grains(found(lammps->grains), *lammps, notes.grains);
    if (!lammps->contacts.empty())
      sources.contacts = lammps_contacts(found(lammps->contacts), *lammps, notes.contacts);
  } else {
    const auto& csv = std::get<CsvSource>(description.source);
    sources.grains = csv_frames(found(csv.grains), CsvContent::grains, csv, notes.grains);
    if (!csv.contacts.empty())
      sources.contacts = csv_frames(found(csv.contacts), CsvContent::contacts, csv, notes.contacts);
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
        waiting_->refuse(waiting_->rows(), waiting_->word("time"),
                         "there is no snapshot of grains at this time");
      if (own > time + tolerance) return std::nullopt;
    }
    std::optional<FrameTable> frame = std::move(waiting_);
    do waiting_ = source_();
    while (timed_ && waiting_ && waiting_->repeats(*frame));
    return frame;
  }
  /// Without grains there are none; a frame that says so belongs to no snapshot.
  void pass(const FrameTable& without_grains) {
    if (waiting_ && waiting_->rows() == 0 && (!waiting_->time || waiting_->time == without_grains.time))
      waiting_ = source_();
  }
  bool used_up() const { return !waiting_; }
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

/// What of the snapshots' times and grains must fit from one to the next.
class Sequence {
 public:
  explicit Sequence(const ImportDescription& description) : may_change_(description.grains.may_change) {}

  /// Whether a frame is the one before once more, as programs write it that are started again.
  bool has_again(const FrameTable& table, const Rows& rows) const {
    if (!before_ || table.time != before_->time || rows.grains.size() != rows_.grains.size()) return false;
    return std::all_of(table.columns.begin(), table.columns.end(), [&](const auto& column) {
      const auto same = before_->columns.find(column.first);
      if (same == before_->columns.end()) return false;
      for (std::size_t g = 0; g < rows.grains.size(); ++g)
        if (column.second.values[rows.grains[g]] != same->second.values[rows_.grains[g]]) return false;
      return true;
    });
  }

  void add(FrameTable table, Rows rows, const Scales& scales) {
    std::vector<std::int64_t> ids;
    for (const std::size_t row : rows.grains) ids.push_back(rows.id[row]);
    if (before_) {
      const double time = table.time_in(scales), last = before_->time_in(scales);
      if (!(time > last))
        table.refuse(
            table.rows(), table.word("time"),
            fmt::format("{:.9g} s does not go on from {:.9g} s", time * scales.time_s, last * scales.time_s),
            "times that ascend");
      if (!may_change_) check_same_grains(ids_, ids, table);
    }
    before_ = std::move(table), rows_ = std::move(rows), ids_ = std::move(ids);
  }
  const FrameTable& table() const { return *before_; }
  const Rows& rows() const { return rows_; }

 private:
  bool may_change_;
  std::optional<FrameTable> before_;
  Rows rows_;
  std::vector<std::int64_t> ids_;
};

double checked_time(const FrameTable& table, const Scales& scales) {
  if (!table.time)
    table.refuse(table.rows(), table.word("time"), "the time is not known",
                 "a column time_s or time, or csv.interval_s");
  const double time = table.time_in(scales);
  if (!(std::abs(time) <= largest_imported))
    table.refuse(table.rows(), table.word("time"), fmt::format("is {:.3g} sqrt(d/g)", time),
                 fmt::format("up to {:g} of it", largest_imported));
  return time;
}

}  // namespace

ImportReport import_run(const ImportDescription& description, const fs::path& folder,
                        const std::function<void(const Snapshot&)>& sink) {
  Notes notes;
  Sources sources = sources_of(description, folder, notes);
  std::optional<ContactFrames> contacts;
  if (sources.contacts) contacts.emplace(*sources.contacts);

  ImportReport report;
  Sequence sequence(description);
  std::optional<Snapshot> before;
  std::optional<double> first_time;
  const auto leave_out = [&](const std::string& where, const std::string& why) {
    report.left_out.push_back(where + ": " + why);
  };
  const bool moved = description.grains.velocities == ImportedVelocities::displacements;
  const double turned_before =
      description.drum
          ? std::copysign(2 * std::numbers::pi * description.drum->turns_before, description.drum->speed_rpm)
          : 0;
  while (std::optional<FrameTable> frame = sources.grains()) {
    const std::string where = fmt::format("{}:{}", frame->file, frame->first_line);
    if (contacts && contacts->used_up() && !notes.contacts.cut_off.empty()) {
      leave_out(where, "its contacts are cut off");
      break;
    }
    if (!first_time && frame->rows() == 0) {
      leave_out(where, "has no grains yet");
      if (contacts) contacts->pass(*frame);
      continue;
    }
    Rows own = rows_of(*frame, description);
    if (sequence.has_again(*frame, own)) {
      leave_out(where, "is the snapshot before once more");
      continue;
    }
    if (!first_time) report.scales = scales_for(description, *frame, own);
    const double time = checked_time(*frame, report.scales);
    if (!first_time) first_time = time;
    sequence.add(std::move(*frame), std::move(own), report.scales);
    const FrameTable& table = sequence.table();
    const Rows& rows = sequence.rows();

    Snapshot s = frame_of(description, report.scales);
    s.time = time;
    s.wall_angle = turned_before + s.wall_spin * (time - *first_time);
    add_grains(table, rows, s);
    s.contacts_known = contacts.has_value();
    if (!description.periodic_x && !description.drum) report.unused_period_m = table.period_m;
    if (contacts)
      if (const auto of_time = contacts->at(time, table, report.scales)) {
        add_contacts(*of_time, bodies_of(table, rows, report.scales), s);
        check_push(s, *of_time);
      }
    if (!moved) {
      add_velocities(table, rows, s);
    } else if (before) {
      add_displacements(*before, s);
    } else {
      leave_out(where, "has no snapshot before, and so no velocities");
      before = std::move(s);
      continue;
    }
    s.step = static_cast<std::int64_t>(++report.snapshots);
    report.grains = s.x.size();
    report.contacts += s.contacts.size();
    report.with_spin = !s.spin.empty();
    if (report.snapshots == 1) report.first_time_s = time * report.scales.time_s;
    report.last_time_s = time * report.scales.time_s;
    sink(s);
    if (moved) before = std::move(s);
  }
  if (report.snapshots == 0) throw InputError("the files hold no snapshot");
  for (const SourceNotes& source : {notes.grains, notes.contacts}) {
    if (!source.cut_off.empty()) leave_out(source.cut_off, "is cut off");
    report.unused_columns.insert(report.unused_columns.end(), source.unused_columns.begin(),
                                 source.unused_columns.end());
  }
  if (contacts && notes.grains.cut_off.empty()) contacts->check_used_up();
  report.with_contacts = contacts.has_value();
  report.files = std::move(sources.files);
  return report;
}

}  // namespace drumlin::particles
