#include "particles/import/csv_frames.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>

#include "coupling/core/basics/errors.hpp"
#include "coupling/core/documents/csv.hpp"
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

constexpr std::array si_suffixes{"", "_s", "_m", "_m_s", "_rad_s", "_N_m"};  // as in Quantity

std::string si_suffix(Quantity quantity) { return si_suffixes[static_cast<std::size_t>(quantity)]; }

/// One column of a file: where its numbers go.
struct Target {
  std::string header;  ///< as it stands in the file
  const KnownColumn* column = nullptr;
  bool in_si = true;
};

class CsvFrames {
 public:
  CsvFrames(std::vector<std::filesystem::path> files, CsvContent content, const CsvSource& source,
            SourceNotes& notes)
      : files_(std::move(files)), content_(content), interval_s_(source.interval_s), notes_(notes) {
    if (content == CsvContent::grains) names_ = source.columns, heading_ = source.heading;
  }

  std::optional<FrameTable> next() {
    try {
      return heading_.empty() ? next_of_rows() : next_below_heading();
    } catch (const InputError&) {
      // A killed program leaves a line without its end.
      if (!reader_ || frames_ == 0 || file_ != files_.size() || !(missing_ || reader_->unended())) throw;
      notes_.cut_off = fmt::format("{}:{}", reader_->file(), reader_->number());
      row_waits_ = false;
      return std::nullopt;
    }
  }

 private:
  std::optional<FrameTable> next_of_rows() {
    if (!row_waits_ && !open_next_row()) return std::nullopt;
    FrameTable frame = empty_frame();
    do {
      add_row(frame);
    } while (next_row() && !begins_another(frame));
    if (frame.rows() == 0) frame.first_line = std::max(1, reader_->number());
    ++frames_;
    return frame;
  }

  std::optional<FrameTable> next_below_heading() {
    while (!reader_ || !next_line()) {
      if (file_ == files_.size()) return std::nullopt;
      open_next_file();
    }
    FrameTable frame = empty_frame();
    split();
    if (fields_.size() < heading_.size())
      reader_->refuse("", fmt::format("holds {} fields", fields_.size()),
                      fmt::format("at least {}, the names of csv.heading", heading_.size()));
    double count = 0;
    for (std::size_t i = 0; i < heading_.size(); ++i) {
      const std::string& name = heading_[i];
      if (name == "count") count = reader_->number_from(fields_[i], name);
      if (name != "time" && name != "time_s") continue;
      frame.time = reader_->number_from(fields_[i], name);
      frame.time_in_si = name == "time_s";
      frame.words["time"] = name;
    }
    if (count != std::floor(count) || !(count >= 0 && count < 1e15))
      reader_->refuse("count", fmt::format("is {}", count), "a whole number >= 0");
    for (auto row = static_cast<std::int64_t>(count); row > 0; --row) {
      if (!next_row()) {
        missing_ = true;
        reader_->refuse("", "ends within a snapshot", fmt::format("{} rows more", row));
      }
      add_row(frame);
    }
    // The last number of a line without an end may lack digits.
    if (reader_->unended() && frames_ > 0) reader_->refuse("", "ends within a line");
    row_waits_ = false;
    ++frames_;
    return frame;
  }

  /// Opens files until one has a row, or is empty but for its names: an instant without contacts.
  bool open_next_row() {
    if (file_ == files_.size()) return false;
    open_next_file();
    next_row();
    return true;
  }

  void open_next_file() {
    reader_.reset();  // a file that cannot be opened is no end of this one
    reader_ = std::make_unique<LineReader>(files_[file_++]);
    if (names_.empty()) {
      if (!next_line()) reader_->refuse("", "holds no line of column names", "docs/formats/import.md");
      split();
      use_names({fields_.begin(), fields_.end()});
    } else {
      use_names(names_);
    }
  }

  /// Lines of grains and numbers; not empty ones and comments.
  bool next_line() {
    while (reader_->next())
      if (!reader_->line().empty() && reader_->line().front() != '#') return true;
    return false;
  }

  void split() {
    if (names_.empty()) return csv_fields(reader_->line(), fields_);
    spaced_ = reader_->line();
    std::replace(spaced_.begin(), spaced_.end(), ',', ' ');
    fields_ = words_of(spaced_);
  }

  bool next_row() {
    row_waits_ = next_line();
    if (!row_waits_) return false;
    split();
    if (names_.empty() ? fields_.size() != targets_.size() : fields_.size() < targets_.size())
      reader_->refuse("", fmt::format("holds {} fields", fields_.size()),
                      fmt::format("{}, as many as there are names", targets_.size()));
    row_.resize(targets_.size());
    for (std::size_t i = 0; i < targets_.size(); ++i)
      if (targets_[i].column) row_[i] = reader_->number_from(fields_[i], targets_[i].header);
    return true;
  }

  void use_names(const std::vector<std::string>& names) {
    targets_.clear();
    time_ = -1;
    for (const std::string& name : names) {
      if (name.find_first_of(";\t") != name.npos)
        reader_->refuse("", fmt::format("the name \"{}\" holds a semicolon or a tab", name),
                        "commas between names and numbers, points before decimals");
      Target target{name, nullptr, true};
      for (const KnownColumn& column : known_columns(content_)) {
        const std::string suffix = si_suffix(column.quantity);
        if (name != column.name && name != column.name + suffix) continue;
        target.column = &column;
        target.in_si = !suffix.empty() && name != column.name;
        for (const Target& other : targets_)
          if (other.column == &column) reader_->refuse(name, "appears twice", "one column for each quantity");
        if (column.quantity == Quantity::time) time_ = static_cast<int>(targets_.size());
      }
      if (target.header.empty()) target.header = fmt::format("column {} without a name", targets_.size() + 1);
      if (!target.column) notes_.unused_columns.insert(target.header);
      targets_.push_back(target);
    }
  }

  FrameTable empty_frame() const {
    FrameTable frame;
    frame.file = reader_->file();
    frame.first_line = reader_->number();
    for (const KnownColumn& column : known_columns(content_))
      frame.words[column.name] = column.name + si_suffix(column.quantity);
    if (time_ >= 0 && row_waits_) {
      frame.time = row_[static_cast<std::size_t>(time_)];
      frame.time_in_si = targets_[static_cast<std::size_t>(time_)].in_si;
    } else if (interval_s_) {
      frame.time = static_cast<double>(frames_) * *interval_s_;
    }
    for (const Target& target : targets_) {
      frame.all_names += (frame.all_names.empty() ? "" : ", ") + target.header;
      if (!target.column) continue;
      frame.words[target.column->name] = target.header;
      if (target.column->quantity != Quantity::time)
        frame.columns[target.column->name] = {{}, target.column->quantity, target.in_si};
    }
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
  SourceNotes& notes_;
  std::vector<std::string> names_;    ///< of the columns; empty: they stand in the file
  std::vector<std::string> heading_;  ///< names of the line above each snapshot; empty: there is none
  std::size_t file_ = 0, frames_ = 0;
  std::unique_ptr<LineReader> reader_;
  std::vector<Target> targets_;
  int time_ = -1;       ///< which field is the time; -1: none
  std::string spaced_;  ///< the line without its commas
  std::vector<std::string_view> fields_;
  std::vector<double> row_;
  bool row_waits_ = false;  ///< row_ belongs to the next frame
  bool missing_ = false;    ///< a frame ended with its file
};

}  // namespace

FrameTableSource csv_frames(std::vector<std::filesystem::path> files, CsvContent content,
                            const CsvSource& source, SourceNotes& notes) {
  const auto frames = std::make_shared<CsvFrames>(std::move(files), content, source, notes);
  return [frames] { return frames->next(); };
}

}  // namespace drumlin::particles
