#include "tools/hard_cases/matrix.hpp"

#include <algorithm>
#include <chrono>
#include <iomanip>
#include <ostream>
#include <sstream>

#include "tools/csv.hpp"
#include "tools/hard_cases/text.hpp"

namespace rigid_body_sim::hard_cases {
namespace {

using reference::Bound;
using reference::HardCase;
using reference::Outcome;

std::vector<std::string> rungsOf(const Plan& plan) {
  std::vector<std::string> rungs;
  for (const std::string& name : plan.rungs) integratorNamed(name);
  for (const IntegratorRow& row : integrators())
    if (plan.rungs.empty() ||
        std::find(plan.rungs.begin(), plan.rungs.end(), row.name) != plan.rungs.end())
      rungs.push_back(row.name);
  return rungs;
}

/// What a cell says: the error where the flight holds, what became of it where not.
std::string inACell(const Cell& cell) {
  const reference::Verdict& verdict = cell.verdict;
  const std::size_t shown = shownOf(verdict);
  switch (verdict.outcome) {
    case Outcome::kHolds:
      return text(verdict.errors.front(), 2);
    case Outcome::kInfinite:
      return "inf " + text(verdict.end_s, 3) + "s";
    case Outcome::kRefused:
      return "refused";
    default:
      return (verdict.outcome == Outcome::kDrifts ? "~" : "x") + text(verdict.errors[shown], 2) +
             (shown == 0 ? "" : std::string(" ") + wordsOf(cell.one->must[shown].measure).name);
  }
}

/// The parts of a case's first bound in words: `2.2e-16 a tick + 16 ulps`.
std::string boundInWords(const Bound& bound) {
  std::string words = bound.most > 0 ? text(bound.most, 2) : "";
  const auto add = [&](double part, const std::string& unit) {
    if (part > 0) words += (words.empty() ? "" : " + ") + text(part, 2) + unit;
  };
  add(bound.a_tick, " a tick");
  add(bound.ulps, " ulps of the input");
  return words.empty() ? "not a bit" : words;
}

void writeCases(const std::vector<Cell>& cells, const std::string& folder) {
  std::ofstream file = openCsv(folder, "cases.csv");
  file << "case,what,ticks,step_s,measure,unit,bound,bound_in_words,why,source,elsewhere\n";
  const HardCase* last = nullptr;
  for (const Cell& cell : cells) {
    if (cell.one == last) continue;
    last = cell.one;
    const Bound& bound = last->must.front();
    const auto flown = std::find_if(cells.begin(), cells.end(), [&](const Cell& other) {
      return other.one == last && !other.verdict.bounds.empty();
    });
    file << last->name << ',' << quoted(last->what) << ',' << last->ticks << ','
         << text(sceneOf(*last, Scene().integrator).step_s(), 12) << ','
         << wordsOf(bound.measure).name << ',' << wordsOf(bound.measure).unit << ','
         << (flown == cells.end() ? "" : text(flown->verdict.bounds.front(), 6)) << ','
         << quoted(boundInWords(bound)) << ',' << quoted(bound.why) << ',' << quoted(last->source)
         << ',' << quoted(last->elsewhere) << '\n';
  }
  closeCsv(file, folder);
}

void printBroken(const std::vector<Cell>& cells, std::ostream& out) {
  for (const Cell& cell : cells)
    if (!cell.keepsClaim())
      out << "\nBROKEN: " << cell.one->name << " with " << cell.rung << " is claimed to be '"
          << nameOf(cell.claim.outcome) << "' and is '" << nameOf(cell.verdict.outcome) << "'";
}

}  // namespace

std::vector<Cell> fly(const Plan& plan,
                      const std::function<void(const std::string& what, double part)>& progress) {
  using Clock = std::chrono::steady_clock;
  const auto cases = casesNamed(plan.cases);
  const auto rungs = rungsOf(plan);
  std::vector<Cell> cells;
  for (const HardCase* one : cases) {
    for (const std::string& rung : rungs) {
      progress(one->name + ", " + rung, static_cast<double>(cells.size()) /
                                            static_cast<double>(cases.size() * rungs.size()));
      const auto start = Clock::now();
      cells.push_back({one, rung, claimOf(*one, rung), judge(*one, rung, plan.takes_its_time)});
      cells.back().wall_s = std::chrono::duration<double>(Clock::now() - start).count();
    }
  }
  return cells;
}

void print(const std::vector<Cell>& cells, std::ostream& out) {
  if (cells.empty()) return;
  std::vector<std::string> rungs;
  for (const Cell& cell : cells)
    if (cell.one == cells.front().one) rungs.push_back(cell.rung);
  out << "A number: the error, within its bound. ~: drifts, but energy and L are kept to 1%.\n"
         "x: another motion. inf: frozen, as it would have become infinite. !: not as claimed.\n\n";
  for (std::size_t k = 0; k < rungs.size(); ++k)
    out << std::setw(3) << k + 1 << ' ' << rungs[k] << '\n';
  out << '\n' << std::left << std::setw(26) << "case" << std::setw(10) << "measure" << std::right;
  for (std::size_t k = 0; k < rungs.size(); ++k) out << std::setw(11) << k + 1;
  const HardCase* last = nullptr;
  for (const Cell& cell : cells) {
    if (cell.one != last)
      out << '\n'
          << std::left << std::setw(26) << cell.one->name << std::setw(10)
          << wordsOf(cell.one->must.front().measure).name << std::right;
    last = cell.one;
    out << std::setw(11) << inACell(cell) + (cell.keepsClaim() ? "" : "!");
  }
  out << '\n';
  printBroken(cells, out);
}

void writeCsv(const std::vector<Cell>& cells, const std::string& folder) {
  prepareFolder(folder);
  writeCases(cells, folder);
  std::ofstream file = openCsv(folder, "cells.csv");
  file << "case,rung,outcome,claim,keeps_claim,measure,unit,error,bound,end_s,wall_s,why\n";
  for (const Cell& cell : cells) {
    const reference::Verdict& verdict = cell.verdict;
    const bool is_flown = !verdict.errors.empty();
    const std::size_t shown = shownOf(verdict);
    const MeasureWords words = wordsOf(cell.one->must[shown].measure);
    file << cell.one->name << ',' << cell.rung << ',' << nameOf(verdict.outcome) << ','
         << nameOf(cell.claim.outcome) << ',' << cell.keepsClaim() << ',' << words.name << ','
         << words.unit << ',' << (is_flown ? text(verdict.errors[shown], 17) : "") << ','
         << (is_flown ? text(verdict.bounds[shown], 17) : "") << ',' << text(verdict.end_s, 12)
         << ',' << text(cell.wall_s, 3) << ','
         << quoted(verdict.why.empty() ? cell.claim.why : verdict.why) << '\n';
  }
  closeCsv(file, folder);
}

}  // namespace rigid_body_sim::hard_cases
