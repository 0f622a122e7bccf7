#include "particles/import/lammps_frames.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "particles/import/line_reader.hpp"

namespace drumlin::particles {
namespace {

/// A column of the dump: where it goes, what one of its units is in SI, what is added to it.
struct Target {
  std::string name;  ///< empty: not used
  Quantity quantity = Quantity::number;
  double factor = 1, offset = 0;
  bool is_scaled = false;  ///< by the box
};

/// Lower and upper bound of the box along x, y, z.
using Box = std::array<std::array<double, 2>, 3>;

/// What a column of this name means, given the box of its frame.
using Meaning = std::function<Target(std::string_view name, const Box& box)>;

class LammpsFrames {
 public:
  LammpsFrames(std::vector<std::filesystem::path> files, double step_s, std::string rows_item,
               Meaning meaning, UnusedColumns& unused)
      : files_(std::move(files)),
        step_s_(step_s),
        rows_item_(std::move(rows_item)),
        meaning_(std::move(meaning)),
        unused_(unused) {}

  std::optional<FrameTable> next() {
    while (!reader_ || !next_line()) {
      if (file_ == files_.size()) return std::nullopt;
      reader_ = std::make_unique<LineReader>(files_[file_++]);
    }
    FrameTable frame;
    frame.file = reader_->file();
    frame.first_line = reader_->number();
    std::optional<double> count;
    std::optional<Box> box;
    for (;;) {
      const std::string item = reader_->line();
      if (item == "ITEM: TIMESTEP") {
        require_first(!frame.time, "TIMESTEP");
        frame.time = whole_number_below("TIMESTEP") * step_s_;
      } else if (item.starts_with("ITEM: NUMBER OF ")) {
        require_first(!count, "NUMBER OF ...");
        count = whole_number_below("NUMBER OF ...");
      } else if (item.starts_with("ITEM: BOX BOUNDS")) {
        require_first(!box, "BOX BOUNDS");
        read_box(item, box.emplace());
      } else if (item.starts_with(rows_item_)) {
        if (!frame.time) reader_->refuse(rows_item_, "comes before ITEM: TIMESTEP", "");
        if (!count) reader_->refuse(rows_item_, "comes before ITEM: NUMBER OF ...", "");
        read_rows(item, static_cast<std::size_t>(*count), box, frame);
        return frame;
      } else if (item == "ITEM: UNITS" || item == "ITEM: TIME") {
        next_line();
      } else {
        reader_->refuse("", "\"" + item.substr(0, 60) + "\" is not expected here",
                        "ITEM: TIMESTEP, NUMBER OF ..., BOX BOUNDS, " + rows_item_.substr(6));
      }
      if (!next_line()) reader_->refuse("", "ends within a frame", "");
    }
  }

 private:
  bool next_line() {
    while (reader_->next())
      if (!reader_->line().empty()) return true;
    return false;
  }

  void require_first(bool first, const std::string& item) const {
    if (!first) reader_->refuse(item, "stands a second time in this frame", "once in each frame");
  }

  double whole_number_below(const std::string& item) {
    if (!next_line()) reader_->refuse(item, "ends within a frame", "");
    const double value = reader_->number_from(reader_->line(), item);
    if (value < 0 || value > 1e15) reader_->refuse(item, "is out of range", "0 to 1e15");
    if (value != std::floor(value)) reader_->refuse(item, "is " + reader_->line(), "a whole number");
    return value;
  }

  void read_box(const std::string& item, Box& box) {
    if (item.find("xy") != std::string::npos || item.find("abc") != std::string::npos)
      reader_->refuse("BOX BOUNDS", "is triclinic", "a box with right angles");
    for (auto& bounds : box) {
      if (!next_line()) reader_->refuse("BOX BOUNDS", "ends within a frame", "");
      const auto words = words_of(reader_->line());
      if (words.size() != 2)
        reader_->refuse("BOX BOUNDS", fmt::format("holds {} numbers", words.size()),
                        "two: a box with right angles");
      bounds = {reader_->number_from(words[0], "BOX BOUNDS"), reader_->number_from(words[1], "BOX BOUNDS")};
      if (!(bounds[0] <= bounds[1]))
        reader_->refuse("BOX BOUNDS", "are not in their order", "lower, then upper");
    }
  }

  void read_rows(const std::string& item, std::size_t count, const std::optional<Box>& box,
                 FrameTable& frame) {
    std::vector<Target> targets;
    for (const std::string_view name : words_of(std::string_view(item).substr(rows_item_.size()))) {
      Target target = meaning_(name, box.value_or(Box{}));
      if (target.is_scaled && !box)
        reader_->refuse(std::string(name), "is scaled by a box that this frame does not give",
                        "ITEM: BOX BOUNDS before it");
      if (target.name.empty()) {
        unused_.insert(std::string(name));
      } else if (!frame.columns.emplace(target.name, FrameColumn{{}, target.quantity, true}).second) {
        reader_->refuse(std::string(name), "gives " + target.name + " a second time",
                        "one column for each quantity");
      }
      targets.push_back(std::move(target));
    }
    std::vector<FrameColumn*> columns;
    for (const Target& target : targets)
      columns.push_back(target.name.empty() ? nullptr : &frame.columns.at(target.name));
    for (std::size_t row = 0; row < count; ++row) {
      if (!next_line())
        reader_->refuse("", fmt::format("ends after {} rows of a frame", row), fmt::format("{} rows", count));
      const auto words = words_of(reader_->line());
      if (words.size() != targets.size())
        reader_->refuse("", fmt::format("holds {} fields", words.size()),
                        fmt::format("{}, as many as there are names", targets.size()));
      frame.line.push_back(reader_->number());
      for (std::size_t c = 0; c < targets.size(); ++c)
        if (columns[c])
          columns[c]->values.push_back(reader_->number_from(words[c], targets[c].name) * targets[c].factor +
                                       targets[c].offset);
    }
  }

  std::vector<std::filesystem::path> files_;
  double step_s_;
  std::string rows_item_;  ///< "ITEM: ATOMS" or "ITEM: ENTRIES"
  Meaning meaning_;
  UnusedColumns& unused_;
  std::size_t file_ = 0;
  std::unique_ptr<LineReader> reader_;
};

FrameTableSource source_of(std::shared_ptr<LammpsFrames> frames) {
  return [frames = std::move(frames)] { return frames->next(); };
}

}  // namespace

FrameTableSource lammps_grains(std::vector<std::filesystem::path> files, const LammpsSource& source,
                               UnusedColumns& unused) {
  const double metre = source.length_unit_m, second = source.time_unit_s;
  const bool upright = source.plane == "xz";
  // The axes of the plane, the one across it, and the component of the angular velocity that turns in it.
  // With x to the right and y up it points at the onlooker and anticlockwise is positive; with z up it points
  // away.
  const char second_axis = upright ? 'z' : 'y', across = upright ? 'y' : 'z';
  const double clockwise = upright ? 1 : -1;
  const Meaning meaning = [=](std::string_view name, const Box& box) -> Target {
    if (name == "id" || name == "type") return {std::string(name)};
    if (name == "radius") return {"radius", Quantity::length, metre};
    if (name == "diameter") return {"radius", Quantity::length, metre / 2};
    if (name == std::string("omega") + across) return {"spin_clockwise", Quantity::rate, clockwise / second};
    if (name == "vx") return {"v_x", Quantity::velocity, metre / second};
    if (name == std::string("v") + second_axis) return {"v_z", Quantity::velocity, metre / second};
    const char axis = name.empty() ? ' ' : name.front();
    const std::string kind(name.substr(std::min<std::size_t>(1, name.size())));
    const std::string target = axis == 'x' ? "x" : axis == second_axis ? "z" : axis == across ? "third" : "";
    if (target.empty()) return {};
    if (kind.empty() || kind == "u") return {target, Quantity::length, metre};
    if (kind != "s" && kind != "su") return {};
    const auto& bounds = box[static_cast<std::size_t>(axis - 'x')];
    return {target, Quantity::length, (bounds[1] - bounds[0]) * metre, bounds[0] * metre, true};
  };
  return source_of(
      std::make_shared<LammpsFrames>(std::move(files), source.step_s, "ITEM: ATOMS", meaning, unused));
}

FrameTableSource lammps_contacts(std::vector<std::filesystem::path> files, const LammpsSource& source,
                                 UnusedColumns& unused) {
  const double newton =
      source.mass_unit_kg * source.length_unit_m / (source.time_unit_s * source.time_unit_s);
  const double sign = source.force_on == "first" ? 1 : -1;
  const double force = sign * newton / source.depth_m.value_or(1);
  const Meaning meaning = [=, ids = source.contact_ids, forces = source.contact_forces](
                              std::string_view name, const Box&) -> Target {
    if (name == ids.at(0)) return {"i"};
    if (name == ids.at(1)) return {"j"};
    if (name == forces.at(0)) return {"f_x", Quantity::force, force};
    if (name == forces.at(1)) return {"f_z", Quantity::force, force};
    return {};
  };
  return source_of(
      std::make_shared<LammpsFrames>(std::move(files), source.step_s, "ITEM: ENTRIES", meaning, unused));
}

}  // namespace drumlin::particles
