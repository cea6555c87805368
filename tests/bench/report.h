// A benchmark's figures: printed as a table, and as JSON for those who compare runs.
#pragma once

#include <ostream>
#include <string>
#include <utility>
#include <vector>

namespace lightwell::bench {

/// The middle of the values, which may stand in any order; 0 if there are none.
double median(std::vector<double> values);

/// One line of a report: named figures, in order.
struct Row {
  std::vector<std::pair<std::string, std::string>> labels;  // what was measured
  std::vector<std::pair<std::string, double>> figures;      // what came out
};

struct Report {
  std::vector<std::pair<std::string, std::string>> machine;  // device, cores, ...
  std::vector<std::pair<std::string, std::vector<Row>>> sections;

  std::vector<Row>& section(const std::string& name);
};

void print_table(const Report& report, std::ostream& out);
void print_json(const Report& report, std::ostream& out);

}  // namespace lightwell::bench
