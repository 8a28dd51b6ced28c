#include "tools/hard_cases/text.hpp"

#include <sstream>
#include <stdexcept>

namespace rigid_body_sim::hard_cases {

using reference::HardCase;
using reference::Measure;

MeasureWords wordsOf(Measure measure) {
  switch (measure) {
    case Measure::kAttitude:
      return {"attitude", "rad"};
    case Measure::kPosition:
      return {"position", "m"};
    case Measure::kMomentum:
      return {"P", ""};
    case Measure::kAngularMomentum:
      return {"L", ""};
    case Measure::kEnergy:
      return {"energy", ""};
    case Measure::kLength:
      return {"|q|", ""};
  }
  return {"", ""};
}

std::string text(double number, int digits) {
  std::ostringstream text;
  text.precision(digits);
  text << number;
  return text.str();
}

std::vector<const HardCase*> casesNamed(const std::vector<std::string>& names) {
  std::vector<const HardCase*> cases;
  for (const std::string& name : names) cases.push_back(&reference::hardCaseNamed(name));
  if (names.empty())
    for (const HardCase& one : reference::gallery()) cases.push_back(&one);
  return cases;
}

std::size_t shownOf(const reference::Verdict& verdict) {
  for (std::size_t k = 0; k < verdict.errors.size(); ++k)
    if (verdict.errors[k] > verdict.bounds[k]) return k;
  return 0;
}

}  // namespace rigid_body_sim::hard_cases
