#pragma once

// Words that the tables of our rungs and of other engines share.

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

/// The measure to show: the row's first, or the first that is out of its bound.
std::size_t shownOf(const reference::Verdict& verdict);

/// All of the gallery for no name. @throws std::invalid_argument for a case that is not there
std::vector<const reference::HardCase*> casesNamed(const std::vector<std::string>& names);

}  // namespace rigid_body_sim::hard_cases
