#include "tools/hard_cases/peers.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "tools/child_process.hpp"
#include "tools/csv.hpp"
#include "tools/hard_cases/text.hpp"

namespace rigid_body_sim::hard_cases {
namespace {

using reference::HardCase;
using reference::Measure;
using reference::Verdict;

constexpr Fate kFates[] = {Fate::kHolds,   Fate::kDrifts, Fate::kWrong, Fate::kInfinite,
                           Fate::kAnew,    Fate::kThrows, Fate::kEnds,  Fate::kSlow,
                           Fate::kRefused, Fate::kUnasked};

/// An engine by one of its ways of stepping.
struct Engine {
  std::string name;
  std::string program;
};

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream all(text);
  for (std::string line; std::getline(all, line);) lines.push_back(line);
  return lines;
}

std::vector<Engine> enginesOf(const Peers& peers) {
  std::vector<std::string> programs;
  if (std::filesystem::is_directory(peers.folder))
    for (const auto& entry : std::filesystem::directory_iterator(peers.folder))
      if (entry.path().filename().string().rfind("peer_", 0) == 0)
        programs.push_back(std::filesystem::absolute(entry.path()).string());
  std::sort(programs.begin(), programs.end());
  std::vector<Engine> engines;
  for (const std::string& program : programs) {
    ChildProcess process({program, "names"}, peers.folder);
    if (process.exitCode() != 0) continue;
    for (const std::string& line : linesOf(process.said()))
      if (!line.empty() && line != ".") engines.push_back({line, program});
  }
  if (engines.empty())
    throw std::invalid_argument(
        peers.folder +
        ": no other engine there; scripts/compare_hard_cases builds those that "
        "are installed");
  return engines;
}

/// How a process ended that did not answer, and its last words, which say why.
std::string lastWords(const std::string& said, int code) {
  const std::vector<std::string> lines = linesOf(said);
  const auto last = std::find_if(lines.rbegin(), lines.rend(),
                                 [](const std::string& line) { return !line.empty(); });
  return (code < 0 ? "signal " + std::to_string(-code) : "exit code " + std::to_string(code)) +
         (last == lines.rend() ? "" : ": " + *last);
}

/// By way of a wider type, as std::stod() throws on denormal numbers.
double numberIn(const std::string& field) { return static_cast<double>(std::stold(field)); }

/// The answer of bench/hard_case.hpp. False if the line is none.
bool read(const std::string& line, PeerCell& cell) {
  std::vector<std::string> fields;
  std::istringstream words(line);
  for (std::string field; std::getline(words, field, '\t');) fields.push_back(field);
  const auto fate = std::find_if(std::begin(kFates), std::end(kFates), [&](Fate one) {
    return !fields.empty() && fields[0] == nameOf(one);
  });
  if (fate == std::end(kFates) || fields.size() < 5) return false;
  const std::size_t count = std::stoul(fields[4]);
  if (fields.size() < 5 + 2 * count) return false;
  cell.fate = *fate;
  Verdict& verdict = cell.verdict;
  verdict.end_s = numberIn(fields[1]);
  verdict.energy_change = numberIn(fields[2]);
  verdict.momentum_error = numberIn(fields[3]);
  for (std::size_t k = 5; k < 5 + count; ++k) {
    verdict.errors.push_back(numberIn(fields[k]));
    verdict.bounds.push_back(numberIn(fields[k + count]));
  }
  if (fields.size() > 5 + 2 * count) verdict.why = fields[5 + 2 * count];
  return true;
}

PeerCell flyOne(const Peers& peers, const Engine& engine, const HardCase& one) {
  PeerCell cell = {&one, engine.name};
  ChildProcess process({engine.program, "hard", engine.name, one.name}, peers.folder);
  const int code = process.exitCode(peers.longest_s);
  if (code == 0)
    for (const std::string& line : linesOf(process.said()))
      if (read(line, cell)) return cell;
  cell.verdict.why = lastWords(process.said(), code);
  cell.fate = process.isGivenUp() ? Fate::kSlow : Fate::kEnds;
  return cell;
}

/// Energy or angular momentum, whichever is further off: `E -27%`, `E x4e6`, `L 15% off`; or where
/// the case is about something else, how far off that is.
std::string whatIsLost(const HardCase& one, const Verdict& verdict) {
  const Measure measure = one.must.front().measure;
  if (measure != Measure::kAttitude && measure != Measure::kAngularMomentum)
    return text(verdict.errors.front(), 2);
  const double change = verdict.energy_change;
  if (!(std::abs(change) >= verdict.momentum_error))
    return "L " + text(100 * verdict.momentum_error, 2) + "% off";
  if (change > 9) return "E x" + text(1 + change, 1);
  return "E " + std::string(change > 0 ? "+" : "") + text(100 * change, 2) + "%";
}

}  // namespace

const char* nameOf(Fate fate) {
  switch (fate) {
    case Fate::kHolds:
      return "holds";
    case Fate::kDrifts:
      return "drifts";
    case Fate::kWrong:
      return "wrong";
    case Fate::kInfinite:
      return "infinite";
    case Fate::kAnew:
      return "anew";
    case Fate::kThrows:
      return "throws";
    case Fate::kEnds:
      return "ends";
    case Fate::kSlow:
      return "slow";
    case Fate::kRefused:
      return "refused";
    case Fate::kUnasked:
      return "unasked";
  }
  return "";
}

std::vector<std::string> engineNames(const Peers& peers) {
  std::vector<std::string> names;
  for (const Engine& engine : enginesOf(peers)) names.push_back(engine.name);
  return names;
}

std::vector<PeerCell> flyPeers(
    const Peers& peers, const std::vector<std::string>& cases,
    const std::function<void(const std::string& what, double part)>& progress) {
  const std::vector<Engine> engines = enginesOf(peers);
  const std::vector<const HardCase*> all = casesNamed(cases);
  std::vector<PeerCell> cells;
  for (const HardCase* one : all) {
    for (const Engine& engine : engines) {
      progress(
          one->name + ", " + engine.name,
          static_cast<double>(cells.size()) / static_cast<double>(all.size() * engines.size()));
      cells.push_back(flyOne(peers, engine, *one));
    }
  }
  return cells;
}

std::string inACell(const PeerCell& cell) {
  const Verdict& verdict = cell.verdict;
  const std::size_t shown = shownOf(verdict);
  switch (cell.fate) {
    case Fate::kHolds:
      return text(verdict.errors.front(), 2);
    case Fate::kDrifts:
      return "~" + text(verdict.errors[shown], 2) +
             (shown == 0 ? "" : std::string(" ") + wordsOf(cell.one->must[shown].measure).name);
    case Fate::kWrong:
      return "x " + whatIsLost(*cell.one, verdict);
    case Fate::kInfinite:
      return "inf " + text(verdict.end_s, 3) + "s";
    case Fate::kAnew:
      return "anew " + text(verdict.end_s, 3) + "s";
    case Fate::kUnasked:
      return "-";
    default:
      return nameOf(cell.fate);
  }
}

void print(const std::vector<PeerCell>& cells, std::ostream& out) {
  if (cells.empty()) return;
  out << "\nOther engines, at the same step and by the same bounds. x: what of energy or L is lost "
         "or "
         "gained.\nanew: begins again by itself. throws: an exception. ends: ends its process. "
         "slow: not there in time.\n-: cannot be told.\n\n"
      << std::left << std::setw(26) << "case" << std::right;
  for (const PeerCell& cell : cells)
    if (cell.one == cells.front().one) out << std::setw(15) << cell.engine;
  const HardCase* last = nullptr;
  for (const PeerCell& cell : cells) {
    if (cell.one != last) out << '\n' << std::left << std::setw(26) << cell.one->name << std::right;
    last = cell.one;
    out << std::setw(15) << inACell(cell);
  }
  out << '\n';
}

void writeCsv(const std::vector<PeerCell>& cells, const std::string& folder) {
  std::ofstream file = openCsv(folder, "peers.csv");
  file << "case,engine,fate,says,measure,unit,error,bound,energy_change,momentum_error,end_s,why\n";
  for (const PeerCell& cell : cells) {
    const Verdict& verdict = cell.verdict;
    const bool is_flown = !verdict.errors.empty();
    const std::size_t shown = shownOf(verdict);
    const MeasureWords words = wordsOf(cell.one->must[shown].measure);
    file << cell.one->name << ',' << cell.engine << ',' << nameOf(cell.fate) << ',' << inACell(cell)
         << ',' << words.name << ',' << words.unit << ','
         << (is_flown ? text(verdict.errors[shown], 17) : "") << ','
         << (is_flown ? text(verdict.bounds[shown], 17) : "") << ','
         << text(verdict.energy_change, 17) << ',' << text(verdict.momentum_error, 17) << ','
         << text(verdict.end_s, 12) << ',' << quoted(verdict.why) << '\n';
  }
  closeCsv(file, folder);
}

}  // namespace rigid_body_sim::hard_cases
