#include "particles/import/lammps_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "particles/import/line_reader.hpp"

namespace drumlin::particles {
namespace {

constexpr double same_unit = 1e-6;  // relative: of the digits that a user writes
constexpr const char* second_radius = "second radius";

/// A column of the dump: where it goes, what one of its units is in SI, what is added to it.
struct DumpColumn {
  std::string name;  ///< empty: not used
  Quantity quantity = Quantity::number;
  double factor = 1, offset = 0;
  bool is_scaled = false;  ///< by the box
};

/// Lower and upper bound of the box along x, y, z.
struct DumpBox {
  std::array<std::array<double, 2>, 3> bounds{};
  bool tilted = false;  ///< then the bounds are those around it
  bool periodic_x = false;
};

/// What one unit of the dump is in SI.
struct Units {
  double metre = 1, second = 1, kilogram = 1;
};

/// What a style of ITEM: UNITS stands for; nothing for one that grains do not have.
std::optional<Units> units_of_style(std::string_view style) {
  if (style == "si") return Units{};
  if (style == "cgs") return Units{1e-2, 1, 1e-3};
  if (style == "micro") return Units{1e-6, 1e-6, 1e-15};
  if (style == "nano") return Units{1e-9, 1e-9, 1e-21};
  return std::nullopt;
}

/// What a column of this name means, given the box and the units of its frame.
using Meaning = std::function<DumpColumn(std::string_view name, const DumpBox& box, const Units& units)>;

/// What both kinds of dump have to be told.
struct DumpKind {
  std::string rows_item;  ///< "ITEM: ATOMS" or "ITEM: ENTRIES"
  Meaning meaning;
  std::map<std::string, std::string> words;  ///< what the columns are called in dumps
  bool weighs = false;                       ///< the unit of mass matters
};

class LammpsFrames {
 public:
  LammpsFrames(std::vector<std::filesystem::path> files, const LammpsSource& source, DumpKind kind,
               SourceNotes& notes)
      : files_(std::move(files)), source_(source), kind_(std::move(kind)), notes_(notes) {}

  std::optional<FrameTable> next() {
    while (!reader_ || !next_line()) {
      if (file_ == files_.size()) return std::nullopt;
      reader_.reset();  // a file that cannot be opened is no end of this one
      reader_ = std::make_unique<LineReader>(files_[file_++]);
      style_.clear();
    }
    const int first_line = reader_->number();
    try {
      FrameTable frame = read_frame();
      ++frames_;
      return frame;
    } catch (const InputError&) {
      // A killed program leaves half a frame behind.
      if (frames_ == 0 || file_ != files_.size() || !(missing_ || reader_->unended())) throw;
      notes_.cut_off = fmt::format("{}:{}", reader_->file(), first_line);
      return std::nullopt;
    }
  }

 private:
  FrameTable read_frame() {
    FrameTable frame;
    frame.file = reader_->file();
    frame.first_line = reader_->number();
    frame.words = kind_.words;
    std::optional<double> step, time, count;
    std::optional<DumpBox> box;
    for (;;) {
      const std::string item = reader_->line();
      if (item == "ITEM: TIMESTEP") {
        require_first(!step, "TIMESTEP");
        step = whole_number_below("TIMESTEP");
      } else if (item == "ITEM: TIME") {
        require_first(!time, "TIME");
        time = reader_->number_from(line_below("TIME"), "TIME");
      } else if (item == "ITEM: UNITS") {
        style_ = line_below("UNITS");
        if (style_ != "lj" && !units_of_style(style_))
          reader_->refuse("UNITS", "is \"" + style_ + "\"", "si, cgs, micro, nano, lj");
      } else if (item.starts_with("ITEM: NUMBER OF ")) {
        require_first(!count, "NUMBER OF ...");
        count = whole_number_below("NUMBER OF ...");
      } else if (item.starts_with("ITEM: BOX BOUNDS")) {
        require_first(!box, "BOX BOUNDS");
        const auto words = words_of(item);
        box.emplace().periodic_x = std::find(words.begin(), words.end(), "pp") == words.end() - 3;
        read_box(*box);
      } else if (item.starts_with(kind_.rows_item)) {
        if (!step) reader_->refuse(kind_.rows_item, "comes before ITEM: TIMESTEP", "");
        if (!count) reader_->refuse(kind_.rows_item, "comes before ITEM: NUMBER OF ...", "");
        const Units units = own_units();
        frame.time = time_of(step, time, units);
        if (time) frame.words["time"] = "TIME";
        if (box && box->periodic_x && !box->tilted)
          frame.period_m = (box->bounds[0][1] - box->bounds[0][0]) * units.metre;
        read_rows(item, static_cast<std::size_t>(*count), box, units, frame);
        return frame;
      } else {
        reader_->refuse("", "\"" + item.substr(0, 60) + "\" is not expected here",
                        "ITEM: TIMESTEP, NUMBER OF ..., BOX BOUNDS, " + kind_.rows_item.substr(6));
      }
      if (!next_line()) refuse_end("", "ends within a frame");
    }
  }

  double time_of(const std::optional<double>& step, const std::optional<double>& time,
                 const Units& units) const {
    if (time) return *time * units.second;
    if (!source_.step_s)
      reader_->refuse("TIMESTEP", "counts steps whose length is not known",
                      "ITEM: TIME in each frame, or lammps.step_s in the description");
    return *step * *source_.step_s;
  }

  /// Of the description and of the file, which must not contradict each other.
  Units own_units() const {
    const std::optional<Units> of_style = units_of_style(style_);
    const auto unit = [&](const char* key, const std::optional<double>& told, double Units::*own,
                          bool needed) {
      if (!told && style_ == "lj" && needed)
        reader_->refuse("UNITS", "is \"lj\", which has no dimensions",
                        fmt::format("lammps.{} in the description", key));
      if (told && of_style && std::abs(*told / ((*of_style).*own) - 1) > same_unit)
        reader_->refuse(
            "UNITS",
            fmt::format("is \"{}\", a unit of {:g}; lammps.{} is {:g}", style_, (*of_style).*own, key, *told),
            "a description without the key, or with the same unit");
      return told ? *told : of_style ? (*of_style).*own : 1;
    };
    return {unit("length_unit_m", source_.length_unit_m, &Units::metre, true),
            unit("time_unit_s", source_.time_unit_s, &Units::second, true),
            unit("mass_unit_kg", source_.mass_unit_kg, &Units::kilogram, kind_.weighs)};
  }

  bool next_line() {
    while (reader_->next())
      if (!reader_->line().empty()) return true;
    return false;
  }

  void require_first(bool first, const std::string& item) const {
    if (!first) reader_->refuse(item, "appears a second time in this frame", "once in each frame");
  }

  [[noreturn]] void refuse_end(const std::string& item, const std::string& what,
                               const std::string& allowed = "") {
    missing_ = true;
    reader_->refuse(item, what, allowed);
  }

  const std::string& line_below(const std::string& item) {
    if (!next_line()) refuse_end(item, "ends within a frame");
    return reader_->line();
  }

  double whole_number_below(const std::string& item) {
    const double value = reader_->number_from(line_below(item), item);
    if (value < 0 || value > 1e15) reader_->refuse(item, "is out of range", "0 to 1e15");
    if (value != std::floor(value)) reader_->refuse(item, "is " + reader_->line(), "a whole number");
    return value;
  }

  /// Lines of two numbers, of three where it is tilted along an axis, of four where it lies anyhow.
  void read_box(DumpBox& box) {
    for (auto& bounds : box.bounds) {
      const auto words = words_of(line_below("BOX BOUNDS"));
      if (words.size() < 2 || words.size() > 4)
        reader_->refuse("BOX BOUNDS", fmt::format("holds {} numbers", words.size()), "2 to 4");
      if (words.size() == 4) {
        box.tilted = true;
        continue;
      }
      if (words.size() == 3) box.tilted |= reader_->number_from(words[2], "BOX BOUNDS") != 0;
      bounds = {reader_->number_from(words[0], "BOX BOUNDS"), reader_->number_from(words[1], "BOX BOUNDS")};
      if (!(bounds[0] <= bounds[1]))
        reader_->refuse("BOX BOUNDS", "are not in their order", "lower, then upper");
    }
  }

  /// What the named columns give; of those that give the same the first.
  std::vector<DumpColumn> targets_of(const std::vector<std::string_view>& names,
                                     const std::optional<DumpBox>& box, const Units& units,
                                     FrameTable& frame) {
    std::vector<DumpColumn> targets;
    for (const std::string_view name : names) {
      DumpColumn target = kind_.meaning(name, box.value_or(DumpBox{}), units);
      if (target.name == "radius" && frame.has("radius")) target.name = second_radius;
      if (target.name.empty() || frame.has(target.name)) {
        notes_.unused_columns.insert(std::string(name));
        targets.emplace_back();
        continue;
      }
      if (target.is_scaled && !box)
        reader_->refuse(std::string(name), "is scaled by a box that this frame does not give",
                        "ITEM: BOX BOUNDS before it");
      if (target.is_scaled && box->tilted)
        reader_->refuse(std::string(name), "is scaled by a tilted box", "coordinates that are not");
      frame.columns[target.name] = {{}, target.quantity, true};
      frame.words[target.name] = name;
      targets.push_back(std::move(target));
    }
    return targets;
  }

  void read_rows(const std::string& item, std::size_t count, const std::optional<DumpBox>& box,
                 const Units& units, FrameTable& frame) {
    frame.all_names = item.substr(kind_.rows_item.size());
    const auto names = words_of(std::string_view(item).substr(kind_.rows_item.size()));
    const std::vector<DumpColumn> targets = targets_of(names, box, units, frame);
    std::vector<FrameColumn*> columns;
    for (const DumpColumn& target : targets)
      columns.push_back(target.name.empty() ? nullptr : &frame.columns.at(target.name));
    for (std::size_t row = 0; row < count; ++row) {
      if (!next_line())
        refuse_end("", fmt::format("ends after {} rows of a frame", row), fmt::format("{} rows", count));
      const auto words = words_of(reader_->line());
      if (words.size() != targets.size())
        reader_->refuse("", fmt::format("holds {} fields", words.size()),
                        fmt::format("{}, as many as there are names", targets.size()));
      frame.line.push_back(reader_->number());
      for (std::size_t c = 0; c < targets.size(); ++c)
        if (columns[c])
          columns[c]->values.push_back(
              reader_->number_from(words[c], std::string(names[c])) * targets[c].factor + targets[c].offset);
    }
    // The last number of a line without an end may lack digits.
    if (reader_->unended() && frames_ > 0) refuse_end("", "ends within a line");
    check_radii(frame);
  }

  /// A radius and a diameter say the same.
  static void check_radii(FrameTable& frame) {
    const auto second = frame.columns.extract(second_radius);
    if (second.empty()) return;
    const std::vector<double>&radius = frame.columns.at("radius").values, &other = second.mapped().values;
    for (std::size_t row = 0; row < radius.size(); ++row)
      if (std::abs(radius[row] - other[row]) > same_unit * std::abs(radius[row]))
        frame.refuse(row, "radius, diameter",
                     fmt::format("say that the radius is {:g} m and {:g} m", radius[row], other[row]),
                     "one of them, or a diameter of two radii");
  }

  std::vector<std::filesystem::path> files_;
  LammpsSource source_;
  DumpKind kind_;
  SourceNotes& notes_;
  std::size_t file_ = 0, frames_ = 0;
  std::unique_ptr<LineReader> reader_;
  std::string style_;     ///< of the units, which a file names once; empty: it does not
  bool missing_ = false;  ///< a frame ended with its file
};

FrameTableSource source_of(std::shared_ptr<LammpsFrames> frames) {
  return [frames = std::move(frames)] { return frames->next(); };
}

}  // namespace

FrameTableSource lammps_grains(std::vector<std::filesystem::path> files, const LammpsSource& source,
                               SourceNotes& notes) {
  const bool upright = source.plane == DumpPlane::xz, with_types = !source.wall_types.empty();
  // The axes of the plane, the one across it, and the component of the angular velocity that turns in it.
  // With x to the right and y up it points at the onlooker and anticlockwise is positive; with z up it points
  // away.
  const char second_axis = upright ? 'z' : 'y', across = upright ? 'y' : 'z';
  const double clockwise = upright ? 1 : -1;
  const std::string v_z = std::string("v") + second_axis, spin = std::string("omega") + across;
  DumpKind kind{"ITEM: ATOMS",
                {},
                {{"time", "TIMESTEP"},
                 {"z", std::string(1, second_axis)},
                 {"v_x", "vx"},
                 {"v_z", v_z},
                 {"radius", "radius or diameter"}}};
  kind.meaning = [=](std::string_view name, const DumpBox& box, const Units& units) -> DumpColumn {
    if (name == "id" || (name == "type" && with_types)) return {std::string(name)};
    if (name == "radius") return {"radius", Quantity::length, units.metre};
    if (name == "diameter") return {"radius", Quantity::length, units.metre / 2};
    if (name == spin) return {"spin_clockwise", Quantity::rate, clockwise / units.second};
    if (name == "vx") return {"v_x", Quantity::velocity, units.metre / units.second};
    if (name == v_z) return {"v_z", Quantity::velocity, units.metre / units.second};
    const char axis = name.empty() ? ' ' : name.front();
    const std::string letters(name.substr(std::min<std::size_t>(1, name.size())));
    const std::string target = axis == 'x' ? "x" : axis == second_axis ? "z" : axis == across ? "third" : "";
    if (target.empty()) return {};
    if (letters.empty() || letters == "u") return {target, Quantity::length, units.metre};
    if (letters != "s" && letters != "su") return {};
    const auto& [lower, upper] = box.bounds[static_cast<std::size_t>(axis - 'x')];
    return {target, Quantity::length, (upper - lower) * units.metre, lower * units.metre, true};
  };
  return source_of(std::make_shared<LammpsFrames>(std::move(files), source, std::move(kind), notes));
}

FrameTableSource lammps_contacts(std::vector<std::filesystem::path> files, const LammpsSource& source,
                                 SourceNotes& notes) {
  const auto &ids = source.contact_ids, &forces = source.contact_forces;
  const double sign = source.force_on == ForceOn::first ? 1 : -1, depth = source.depth_m.value_or(1);
  DumpKind kind{"ITEM: ENTRIES",
                {},
                {{"time", "TIMESTEP"},
                 {"i", ids.at(0)},
                 {"j", ids.at(1)},
                 {"f_x", forces.at(0)},
                 {"f_z", forces.at(1)}},
                true};
  kind.meaning = [=](std::string_view name, const DumpBox&, const Units& units) -> DumpColumn {
    const double force = sign * units.kilogram * units.metre / (units.second * units.second) / depth;
    if (name == ids[0]) return {"i"};
    if (name == ids[1]) return {"j"};
    if (name == forces[0]) return {"f_x", Quantity::force, force};
    if (name == forces[1]) return {"f_z", Quantity::force, force};
    return {};
  };
  return source_of(std::make_shared<LammpsFrames>(std::move(files), source, std::move(kind), notes));
}

}  // namespace drumlin::particles
