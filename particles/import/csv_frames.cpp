#include "particles/import/csv_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "coupling/documents/csv.hpp"
#include "coupling/documents/enum_names.hpp"
#include "particles/import/line_reader.hpp"

namespace drumlin::particles {
namespace {

struct KnownColumn {
  const char* name;
  Quantity quantity;
};

const std::vector<KnownColumn>& known_columns(CsvContent content) {
  static const std::vector<KnownColumn> of_grains{{"time", Quantity::time},
                                                  {"id", Quantity::number},
                                                  {"x", Quantity::length},
                                                  {"z", Quantity::length},
                                                  {"v_x", Quantity::velocity},
                                                  {"v_z", Quantity::velocity},
                                                  {"radius", Quantity::length},
                                                  {"spin_clockwise", Quantity::rate},
                                                  {"spin_anticlockwise", Quantity::rate}};
  static const std::vector<KnownColumn> of_contacts{
      {"time", Quantity::time},       {"i", Quantity::number},        {"j", Quantity::number},
      {"normal_x", Quantity::number}, {"normal_z", Quantity::number}, {"f_n", Quantity::force},
      {"f_t", Quantity::force},       {"f_x", Quantity::force},       {"f_z", Quantity::force}};
  return content == CsvContent::grains ? of_grains : of_contacts;
}

constexpr EnumNames<Quantity, 6> si_suffixes{{{Quantity::number, ""},
                                              {Quantity::time, "_s"},
                                              {Quantity::length, "_m"},
                                              {Quantity::velocity, "_m_s"},
                                              {Quantity::rate, "_rad_s"},
                                              {Quantity::force, "_N_m"}}};

std::string si_suffix(Quantity quantity) { return name_in(si_suffixes, quantity); }

/// One column of a file: where its numbers go.
struct Target {
  std::string header;  ///< as it stands in the file
  const KnownColumn* column = nullptr;
  bool in_si = true;
};

class CsvFrames {
 public:
  CsvFrames(std::vector<std::filesystem::path> files, CsvContent content, std::optional<double> interval_s,
            UnusedColumns& unused)
      : files_(std::move(files)), content_(content), interval_s_(interval_s), unused_(unused) {}

  std::optional<FrameTable> next() {
    if (!row_waits_ && !open_next_row()) return std::nullopt;
    FrameTable frame = empty_frame();
    do {
      add_row(frame);
    } while (next_row() && !begins_another(frame));
    if (frame.rows() == 0) frame.first_line = std::max(1, reader_->number());
    ++frames_;
    return frame;
  }

 private:
  /// Opens files until one has a row, or is empty but for its names: an instant without contacts.
  bool open_next_row() {
    if (file_ == files_.size()) return false;
    reader_ = std::make_unique<LineReader>(files_[file_++]);
    read_names();
    next_row();
    return true;
  }

  bool next_row() {
    row_waits_ = false;
    while (reader_->next()) {
      if (reader_->line().empty() || reader_->line().front() == '#') continue;
      csv_fields(reader_->line(), fields_);
      if (fields_.size() != targets_.size())
        reader_->refuse("", fmt::format("holds {} fields", fields_.size()),
                        fmt::format("{}, as many as there are names", targets_.size()));
      row_.resize(fields_.size());
      for (std::size_t i = 0; i < fields_.size(); ++i)
        if (targets_[i].column) row_[i] = reader_->number_from(fields_[i], targets_[i].header);
      row_waits_ = true;
      return true;
    }
    return false;
  }

  void read_names() {
    targets_.clear();
    time_ = -1;
    bool found = false;
    while (!found && reader_->next()) found = !reader_->line().empty() && reader_->line().front() != '#';
    if (!found) reader_->refuse("", "holds no line of column names", "docs/formats/import.md");
    csv_fields(reader_->line(), fields_);
    for (const std::string_view name : fields_) {
      Target target{std::string(name), nullptr, true};
      for (const KnownColumn& column : known_columns(content_)) {
        const std::string suffix = si_suffix(column.quantity);
        if (name != column.name && name != column.name + suffix) continue;
        target.column = &column;
        target.in_si = !suffix.empty() && name != column.name;
        for (const Target& other : targets_)
          if (other.column == &column)
            reader_->refuse(std::string(name), "stands twice", "one column for each quantity");
        if (column.quantity == Quantity::time) time_ = static_cast<int>(targets_.size());
      }
      if (!target.column) unused_.insert(std::string(name));
      targets_.push_back(target);
    }
  }

  FrameTable empty_frame() const {
    FrameTable frame;
    frame.file = reader_->file();
    frame.first_line = reader_->number();
    if (time_ >= 0 && row_waits_) {
      frame.time = row_[static_cast<std::size_t>(time_)];
      frame.time_in_si = targets_[static_cast<std::size_t>(time_)].in_si;
    } else if (interval_s_) {
      frame.time = static_cast<double>(frames_) * *interval_s_;
    }
    for (const Target& target : targets_)
      if (target.column && target.column->quantity != Quantity::time)
        frame.columns[target.column->name] = {{}, target.column->quantity, target.in_si};
    return frame;
  }

  void add_row(FrameTable& frame) {
    if (!row_waits_) return;
    frame.line.push_back(reader_->number());
    for (std::size_t i = 0; i < targets_.size(); ++i)
      if (targets_[i].column && targets_[i].column->quantity != Quantity::time)
        frame.columns[targets_[i].column->name].values.push_back(row_[i]);
  }

  bool begins_another(const FrameTable& frame) const {
    return time_ >= 0 && row_[static_cast<std::size_t>(time_)] != *frame.time;
  }

  std::vector<std::filesystem::path> files_;
  CsvContent content_;
  std::optional<double> interval_s_;
  UnusedColumns& unused_;
  std::size_t file_ = 0, frames_ = 0;
  std::unique_ptr<LineReader> reader_;
  std::vector<Target> targets_;
  int time_ = -1;  ///< which field is the time; -1: none
  std::vector<std::string_view> fields_;
  std::vector<double> row_;
  bool row_waits_ = false;  ///< row_ belongs to the next frame
};

}  // namespace

FrameTableSource csv_frames(std::vector<std::filesystem::path> files, CsvContent content,
                            std::optional<double> interval_s, UnusedColumns& unused) {
  const auto frames = std::make_shared<CsvFrames>(std::move(files), content, interval_s, unused);
  return [frames] { return frames->next(); };
}

}  // namespace drumlin::particles
