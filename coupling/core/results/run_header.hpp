#pragma once
// The header of a file of results: what was measured or computed, where, and with which settings.
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "coupling/core/basics/geometry.hpp"

namespace drumlin {

/// Which simulator a file comes from.
enum class RunSide { particles, continuum };
constexpr auto names_of(RunSide) { return std::array{"particles", "continuum"}; }

/// The lines "key = value" of profiles.csv and maps.h5, dimensionless (docs/conventions.md). A key that a
/// file does not have is an empty member; NaN is a number that could not be measured.
struct RunHeader {
  std::optional<RunSide> side;
  std::optional<bool> reduced;       ///< a smaller drum than the one it stands for
  std::optional<std::string> title;  ///< of the scene
  std::optional<Geometry> geometry;
  std::optional<std::string> revision;  ///< of the program that wrote the file

  std::optional<double> theta_deg;     ///< slope of the surface: of the frame's x axis below the horizontal
  std::optional<double> axis_depth;    ///< height of the drum's axis above z = 0, d
  std::optional<double> wall_z;        ///< of the wall below the profile, d
  std::optional<double> rotation;      ///< angular velocity of the drum, 1/sqrt(d/g)
  std::optional<double> drum_radius;   ///< d; 0: no drum
  std::optional<double> diameter_m;    ///< d in metres
  std::optional<double> inner_radius;  ///< of an annulus, d
  std::optional<double> outer_radius;  ///< of an annulus, d
  std::optional<double> gap;           ///< from wall to wall or surface, d

  std::optional<double> position;         ///< x of the profile, d
  std::optional<double> slice_width;      ///< d
  std::optional<double> layer_thickness;  ///< d
  std::optional<double> H;                ///< depth of the flowing layer there, d

  std::optional<std::size_t> snapshots;   ///< that were averaged
  std::optional<std::size_t> batches;     ///< of the intervals
  std::optional<double> interval_factor;  ///< half width of a 99 % interval per standard error
  std::optional<std::string> band;        ///< what the intervals of a continuum stand for
  std::optional<std::string> kernel;      ///< of a map of particles
  std::optional<double> kernel_width;     ///< d

  /// Keys that this version does not know, as they stand in the file.
  std::map<std::string, std::string> further;

  bool operator==(const RunHeader&) const = default;
};

/// A number of the header, to be named together with its key.
using HeaderNumber = std::optional<double> RunHeader::*;
/// The key under which files hold it.
std::string key_of(HeaderNumber number);

/// Without what belongs to the slice of a profile alone: position, slice_width, layer_thickness, wall_z.
RunHeader header_of_maps(RunHeader profile);

/// NaN when the header does not have it.
double number_or_nan(const RunHeader& header, HeaderNumber number);
/// Throws InputError with `file` and key when it is missing or not finite.
double needed_number(const RunHeader& header, HeaderNumber number, const std::string& file);

/// All entries as files hold them, key and text in the order of the keys. Numbers are the shortest text that
/// reads back to the same number.
std::map<std::string, std::string> header_texts(const RunHeader& header);
/// One of them; nothing when the header does not have the key.
std::optional<std::string> header_text(const RunHeader& header, const std::string& key);

/// The lines "PREFIXkey = value" of a file, in the order of the keys.
std::string header_lines(const RunHeader& header, std::string_view prefix);
/// What keeps a header from being written and read back, in words; empty when nothing does.
std::string fault_of(const RunHeader& header);

/// One line "key = value" and its number in the file.
struct HeaderLine {
  int line = 0;
  std::string_view text;
};
/// Throws InputError with file, line, key, value and what is allowed, all faults at once: a line without "=",
/// a key that appears twice, a number that is none (nan is one, inf is not), another side, another truth
/// value.
RunHeader read_header(const std::vector<HeaderLine>& lines, const std::string& file);

}  // namespace drumlin
