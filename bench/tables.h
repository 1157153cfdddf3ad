// What the programs print and write: tables for people, CSV and JSON for the report.
#pragma once

#include <string>
#include <vector>

#include "trial.h"

namespace bench {

// Markdown-like table of the trials of one problem, fastest first; those on the front are marked.
void print_trials(const Problem& problem, const std::vector<Trial>& trials, bool all);

// The figures that the project asks of method `spring`, measured against asked.
void print_targets(const std::vector<Problem>& problems, const std::vector<Trial>& trials);

// The work-precision diagram of one problem as PATH.svg and, where it can be made, PATH.png.
void write_diagram(const std::string& path, const Problem& problem,
                   const std::vector<Trial>& trials);

// All trials; throws std::runtime_error when the file cannot be written.
void write_csv(const std::string& path, const std::vector<Trial>& trials);
void write_json(const std::string& path, const std::vector<Trial>& trials,
                const std::vector<Problem>& problems);

}  // namespace bench
