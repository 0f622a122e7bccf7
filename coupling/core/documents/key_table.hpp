#pragma once
// One description of the keys of a struct, written once, that reads it from a document, writes it and lists
// it:
//
//     template <class Visitor> void describe(Visitor& v, Gravity& g) {
//       v.value("acceleration_m_s2", g.acceleration_m_s2, defaulted("m/s2", above(0), "Strength."));
//     }
//     std::vector<InputProblem> problems;
//     auto scene = read_keys<Scene>(document, problems);   // every problem of the file at once
//     std::string text = toml_text(write_keys(scene));     // resolved: holds the defaults too
//     std::vector<KeyRow> rows = list_keys<Scene>();
//
// A default is what the default-constructed struct holds. Paths are those of overrides:
// "stages.1.time_step_s".
#include <string>
#include <vector>

#include "coupling/core/documents/key_lister.hpp"
#include "coupling/core/documents/key_reader.hpp"
#include "coupling/core/documents/key_writer.hpp"
#include "coupling/core/documents/toml_text.hpp"

namespace drumlin {

/// Reads T, whose keys `describe` tells, from the root of a document. Problems are appended, in the order of
/// the file; if there are any, the result is incomplete and fit only for finding more problems.
template <class T>
T read_keys(const Document& document, std::vector<InputProblem>& problems) {
  T result{};
  KeyReader reader(document, problems);
  describe(reader, result);
  reader.finish();
  return result;
}

template <class T>
Node write_keys(T source) {
  KeyWriter writer;
  describe(writer, source);
  return writer.take();
}

template <class T>
std::vector<KeyRow> list_keys() {
  KeyLister lister;
  T standard{};
  describe(lister, standard);
  return lister.take();
}

}  // namespace drumlin
