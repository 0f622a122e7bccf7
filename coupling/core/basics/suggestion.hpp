#pragma once
// The known word that a misspelt one was meant to be.
#include <string>
#include <vector>

namespace drumlin {

/// `; did you mean "X"?` with the nearest of the known words, by letters to add, leave out or replace
/// (Levenshtein); empty where more than a third of the letters, and more than two, differ from every one.
std::string suggestion(const std::string& word, const std::vector<std::string>& known);

}  // namespace drumlin
