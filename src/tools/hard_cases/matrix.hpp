#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

#include "reference/gallery.hpp"

namespace rigid_body_sim::hard_cases {

/// One case flown with one rung.
struct Cell {
  const reference::HardCase* one;
  std::string rung;
  reference::Claim claim;
  reference::Verdict verdict;
  double wall_s = 0;

  bool keepsClaim() const { return keeps(claim, verdict); }
};

struct Plan {
  std::vector<std::string> cases;  ///< empty: all
  std::vector<std::string> rungs;  ///< empty: all
  bool takes_its_time = false;     ///< cases that have a long way go it
};

/// Flies all; case by case, rungs in the registry's order. @param progress what, and the part done
/// @throws std::invalid_argument for a case or rung that is not there
std::vector<Cell> fly(const Plan& plan,
                      const std::function<void(const std::string& what, double part)>& progress);

/// A row a case, a column a rung, and what is broken in sentences.
void print(const std::vector<Cell>& cells, std::ostream& out);

/// What scripts/plot_hard_cases reads; makes the folder if it is not there.
///   cases.csv  a line a case: what is hard, what is measured and how large it may be, sources
///   cells.csv  a line a case and rung: outcome, claim, error and bound of the first measure
///              that is out of its bound, or else of the row's first
/// @throws std::invalid_argument if a file cannot be written
void writeCsv(const std::vector<Cell>& cells, const std::string& folder);

}  // namespace rigid_body_sim::hard_cases
