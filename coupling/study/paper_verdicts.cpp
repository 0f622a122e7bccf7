#include "coupling/study/paper_verdicts.hpp"

#include <cmath>
#include <limits>
#include <map>

#include "coupling/comparison/paper_file.hpp"

namespace drumlin::coupling {
namespace {

using Expects = PaperEntry::Expects;

constexpr double near_share = 0.1;
constexpr double wide_share = 0.25;

PaperEntry entry_from(const Node& node, const std::string& source) {
  PaperEntry entry;
  entry.quantity = text_in(node.find("name"));
  entry.value = number_in(node.find("value"));
  if (const Node* speed = node.find("rotation_rpm")) entry.rotation_rpm = number_in(speed);
  if (const Node* half_width = node.find("half_width")) entry.half_width = number_in(half_width);
  entry.source = node.find("source") == nullptr ? source : text_in(node.find("source"));
  entry.remark = text_in(node.find("remark"));
  if (text_in(node.find("x_axis")) == "upslope") entry.value = -entry.value;
  return entry;
}

void add_table_one(std::vector<PaperEntry>& entries, const std::filesystem::path& folder) {
  const Document table = paper_file(folder / "rotations.toml");
  for (const char* name : {"Q", "theta_deg", "H"})
    for (const Node& row : paper_entries(table, "rotation")) {
      PaperEntry entry = entry_from(row, text_in(table.root.find("source")));
      entry.quantity = name;
      entry.value = number_in(row.find(name));
      entries.push_back(entry);
    }
}

/// The paper does not say how it measures the slope. An entry that rests on it is asked twice: of the slope
/// of the surface, and of the angle of the centre of mass.
void add_other_slope(std::vector<PaperEntry>& entries) {
  std::vector<PaperEntry> others;
  for (PaperEntry other : entries) {
    if (other.quantity == "theta_deg")
      other.quantity = "theta_com_deg";
    else if (other.quantity.starts_with("effective_friction.") || other.quantity.starts_with("shear_rate."))
      other.quantity.insert(other.quantity.find('.'), "_com");
    else
      continue;
    other.remark = "the same entry, with the angle of the centre of mass as the slope";
    others.push_back(other);
  }
  entries.insert(entries.end(), others.begin(), others.end());
}

void add_laws(std::vector<PaperEntry>& entries, const std::filesystem::path& folder) {
  for (const Node& law : paper_entries(paper_file(folder / "laws.toml"), "law")) {
    const Node* coefficients = law.find("coefficients");
    const auto* table = coefficients == nullptr ? nullptr : std::get_if<Node::Table>(&coefficients->value);
    if (table == nullptr) continue;
    for (const auto& [coefficient, value] : *table) {
      // Neither the range of a law is a result, nor the volume fraction that a stress is expected from.
      if (coefficient == "I_min" || coefficient == "I_max" || coefficient == "nu") continue;
      PaperEntry entry = entry_from(law, "");
      entry.quantity += "." + coefficient;
      entry.value = number_in(&value);
      entry.remark = text_in(law.find("formula"));
      entries.push_back(entry);
    }
  }
}

Expects expectation_from(const Document& document, const Node& claim) {
  static const std::map<std::string, Expects> words{{"zero", Expects::zero},
                                                    {"not zero", Expects::not_zero},
                                                    {"positive", Expects::positive},
                                                    {"collapse", Expects::collapse},
                                                    {"no collapse", Expects::no_collapse}};
  const auto found = words.find(text_in(claim.find("expects")));
  if (found == words.end())
    throw InputError(
        {InputProblem{document.file, claim.line, claim.column, "expects", "is missing or not known here",
                      "zero, not zero, positive, collapse, no collapse"}});
  return found->second;
}

void add_claims(std::vector<PaperEntry>& entries, const std::filesystem::path& folder) {
  const Document document = paper_file(folder / "claims.toml");
  for (const Node& claim : paper_entries(document, "claim")) {
    PaperEntry entry = entry_from(claim, "");
    entry.expects = expectation_from(document, claim);
    entry.value = 0;
    entry.remark = text_in(claim.find("statement"));
    entries.push_back(entry);
  }
}

struct Outcome {
  Verdict verdict;
  Reason reason;
};

Outcome inside(bool wide) {
  return wide ? Outcome{Verdict::open, Reason::inside_wide_interval}
              : Outcome{Verdict::agrees, Reason::inside_interval};
}

Outcome against_value(const PaperEntry& entry, const Scalar& ours) {
  const double difference = std::abs(ours.value - entry.value);
  const double interval = ours.ci99.value_or(0);
  if (difference <= interval + entry.half_width.value_or(0)) {
    return inside(interval > wide_share * std::abs(entry.value));
  }
  if (difference <= near_share * std::abs(entry.value)) return {Verdict::near, Reason::within_ten_percent};
  return {Verdict::differs, Reason::outside};
}

Outcome against_zero(const Finding& finding) {
  const double size = std::abs(finding.ours.value), interval = finding.ours.ci99.value_or(0);
  if (size <= interval) {
    return inside(interval > wide_share * finding.scale);
  }
  if (size <= near_share * finding.scale) return {Verdict::near, Reason::within_ten_percent};
  return {Verdict::differs, Reason::outside};
}

Outcome against_sign(const PaperEntry& entry, const Scalar& ours) {
  if (!(std::abs(ours.value) > ours.ci99.value_or(std::numeric_limits<double>::infinity())))
    return {Verdict::near, Reason::unresolved};
  const bool as_said = entry.expects == Expects::not_zero || ours.value > 0;
  return as_said ? Outcome{Verdict::agrees, Reason::inside_interval}
                 : Outcome{Verdict::differs, Reason::outside};
}

Outcome against_collapse(const PaperEntry& entry, const Finding& finding) {
  const bool collapse = finding.ours.value <= finding.limit;
  if (collapse == (entry.expects == Expects::collapse)) return {Verdict::agrees, Reason::inside_interval};
  if (!collapse && finding.ours.value <= 2 * finding.limit) return {Verdict::near, Reason::outside};
  return {Verdict::differs, Reason::outside};
}

Outcome outcome_of(const PaperEntry& entry, const Finding& finding) {
  if (!std::isfinite(finding.ours.value)) return {Verdict::not_measured, Reason::absent};
  if (entry.quantity == "Q") return {Verdict::imposed, Reason::given_by_the_scene};
  switch (entry.expects) {
    case Expects::value:
      return against_value(entry, finding.ours);
    case Expects::zero:
      return against_zero(finding);
    case Expects::not_zero:
    case Expects::positive:
      return against_sign(entry, finding.ours);
    case Expects::collapse:
    case Expects::no_collapse:
      return against_collapse(entry, finding);
  }
  return {Verdict::not_measured, Reason::absent};
}

}  // namespace

std::vector<PaperEntry> paper_entries_of(const std::filesystem::path& folder) {
  std::vector<PaperEntry> entries;
  add_table_one(entries, folder);
  for (const Node& observable : paper_entries(paper_file(folder / "observables.toml"), "observable"))
    if (observable.find("law") == nullptr) entries.push_back(entry_from(observable, ""));
  add_laws(entries, folder);
  add_claims(entries, folder);
  add_other_slope(entries);
  return entries;
}

PaperVerdict verdict_on(const PaperEntry& entry, const Finding& finding) {
  const auto [verdict, reason] = outcome_of(entry, finding);
  return {entry, finding, verdict, reason};
}

}  // namespace drumlin::coupling
