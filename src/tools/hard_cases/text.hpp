#pragma once

// Words and files that the tables of our rungs and of other engines share.

#include <fstream>
#include <string>
#include <vector>

#include "reference/gallery.hpp"

namespace rigid_body_sim::hard_cases {

struct MeasureWords {
  const char* name;
  const char* unit;
};
MeasureWords wordsOf(reference::Measure measure);

/// The number with so many digits.
std::string text(double number, int digits);

/// Quoted, as sentences have commas.
std::string quoted(const std::string& text);

/// The measure to show: the row's first, or the first that is out of its bound.
std::size_t shownOf(const reference::Verdict& verdict);

/// All of the gallery for no name. @throws std::invalid_argument for a case that is not there
std::vector<const reference::HardCase*> casesNamed(const std::vector<std::string>& names);

/// A file in the folder, which is made if it is not there; and its end.
/// @throws std::invalid_argument if it cannot be written
std::ofstream open(const std::string& folder, const std::string& name);
void close(std::ofstream& file, const std::string& folder);

}  // namespace rigid_body_sim::hard_cases
