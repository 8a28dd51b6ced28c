#pragma once

#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

// Files of comma-separated values, as the reports write them.
namespace rigid_body_sim {

/// Makes the folder if it is not there, and tries whether files can be written there.
/// @throws std::invalid_argument if not
inline void prepareFolder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const std::string probe = folder + "/.probe";
  if (!std::ofstream(probe))
    throw std::invalid_argument(folder + ": the folder for the output cannot be written to");
  std::filesystem::remove(probe, error);
}

/// In a folder that is there. @throws std::invalid_argument naming what cannot be written
inline std::ofstream openCsv(const std::string& folder, const std::string& name) {
  std::ofstream file(folder + "/" + name);
  if (!file) throw std::invalid_argument(folder + "/" + name + " cannot be written");
  return file;
}

/// @throws std::invalid_argument if not all of it was written
inline void closeCsv(std::ofstream& file, const std::string& folder) {
  file.close();
  if (!file) throw std::invalid_argument(folder + ": the disk is full, or it cannot be written to");
}

/// Sentences have commas, and may have quotation marks.
inline std::string quoted(const std::string& text) {
  std::string doubled;
  for (const char c : text) doubled += c == '"' ? std::string("\"\"") : std::string(1, c);
  return '"' + doubled + '"';
}

}  // namespace rigid_body_sim
