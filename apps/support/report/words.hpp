#pragma once
// How the page says names, numbers and verdicts. All texts returned are HTML.
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace drumlin::apps::report {

using Json = nlohmann::ordered_json;

/// What a name of the files means to a reader; the escaped name itself where nothing better is known.
std::string words_for(const std::string& name);
std::string short_words_for(const std::string& name);  ///< for narrow columns

/// Why a miss of this quantity matters, as a clause; empty for a quantity without one.
std::string meaning_of_a_miss(const std::string& quantity);

bool is_known(const Json& value);

/// Four digits (the JSON file has them all), a dash for what is not known.
std::string shown(const Json& value);
std::string shown_measurement(const Json& measured);  ///< with +- ci99 where there is one
std::string percent(const Json& share);               ///< to a whole per cent
std::string percent_fine(const Json& share);          ///< to a tenth

double value_of(const Json& measured);  ///< of {"value"} or a number; NaN where not known
std::string difference(double from, double to);

/// "sigma_xz, static" of a target.
std::string target_name(const Json& target);

/// Cell of a table with the outcome's colour.
std::string outcome_cell(const std::string& outcome);

/// Decades and degrees have a zero of no meaning: relative errors of them say nothing.
bool has_relative_error(const std::string& field);

/// Name of a side as the reader knows it: "particles", or with the folder where both are of one kind.
std::string side_name(const Json& comparison, const std::string& side);

}  // namespace drumlin::apps::report
