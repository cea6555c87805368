#include "tests/bench/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <sstream>

namespace lightwell::bench {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, std::abs(value) < 100.0 ? "%.3g" : "%.0f", value);
  return text;
}

std::string quoted(const std::string& text) {
  std::ostringstream out;
  out << '"';
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out << '\\' << c;
    else if (static_cast<unsigned char>(c) < 0x20)
      out << ' ';
    else
      out << c;
  }
  out << '"';
  return out.str();
}

// The cells of a section: its titles first.
std::vector<std::vector<std::string>> cells_of(const std::vector<Row>& rows) {
  std::vector<std::vector<std::string>> cells;
  for (const Row& row : rows) {
    std::vector<std::string> titles, line;
    for (const auto& [name, value] : row.labels) titles.push_back(name), line.push_back(value);
    for (const auto& [name, value] : row.figures) titles.push_back(name), line.push_back(number(value));
    if (cells.empty() || cells.front().size() != titles.size()) cells.push_back(titles);
    cells.push_back(line);
  }
  return cells;
}

}  // namespace

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

std::vector<Row>& Report::section(const std::string& name) {
  for (auto& [title, rows] : sections)
    if (title == name) return rows;
  return sections.emplace_back(name, std::vector<Row>()).second;
}

void print_table(const Report& report, std::ostream& out) {
  for (const auto& [name, value] : report.machine) out << name << ": " << value << '\n';
  for (const auto& [title, rows] : report.sections) {
    out << '\n' << title << '\n';
    const auto cells = cells_of(rows);
    std::vector<std::size_t> widths;
    for (const auto& line : cells) {
      widths.resize(std::max(widths.size(), line.size()));
      for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
    }
    for (const auto& line : cells) {
      for (std::size_t i = 0; i < line.size(); ++i)
        out << "  " << (i == 0 ? std::left : std::right) << std::setw(static_cast<int>(widths[i])) << line[i];
      out << '\n';
    }
  }
}

void print_json(const Report& report, std::ostream& out) {
  out << "{\"machine\": {";
  const char* comma = "";
  for (const auto& [name, value] : report.machine)
    out << std::exchange(comma, ", ") << quoted(name) << ": " << quoted(value);
  out << "}";
  for (const auto& [title, rows] : report.sections) {
    out << ",\n " << quoted(title) << ": [";
    const char* row_comma = "";
    for (const Row& row : rows) {
      out << std::exchange(row_comma, ",") << "\n  {";
      comma = "";
      for (const auto& [name, value] : row.labels)
        out << std::exchange(comma, ", ") << quoted(name) << ": " << quoted(value);
      for (const auto& [name, value] : row.figures)
        out << std::exchange(comma, ", ") << quoted(name) << ": " << (std::isfinite(value) ? value : 0.0);
      out << "}";
    }
    out << "]";
  }
  out << "}\n";
}

}  // namespace lightwell::bench
